"""The car's materials. Values are what a screen shows (nothing is gamma-corrected), for one light at a time: what the
studio adds comes by `reflectivity`. Ambient is what a part shows that no light reaches: a share of its own colour."""

OUTSIDE, INSIDE, HIDDEN = 0.26, 0.30, 0.20


def grey(value):
    return value if isinstance(value, (list, tuple)) else (value,) * 3


def rounded(values, alpha=1.0):
    return [round(v, 4) for v in grey(values)] + [alpha]


def add(car):
    def material(name, diffuse, ambient, specular=0.0, shininess=0.0, reflectivity=0.0, alpha=1.0, **more):
        """`ambient` is a share of the diffuse colour, or a colour."""
        own = ambient if isinstance(ambient, tuple) else [ambient * c for c in grey(diffuse)]
        members = {"ambient": rounded(own), "diffuse": rounded(diffuse, alpha), "specular": rounded(specular),
                   "shininess": shininess, "reflectivity": reflectivity, **more}
        car.material(name, **{key: value for key, value in members.items() if value not in (0, [0, 0, 0, 1])})

    paints(material)
    glass(material)
    trim(material)
    metals(material)
    lamps(material)
    interior(material)
    printed(material)
    backgrounds(material)


def paints(material):
    # A broad tinted highlight is the flakes' share, the mirrored studio the clear coat's.
    # Ambient, diffuse and highlight stay below 1 together: they are all there is before a plain background.
    material("Paint red", (0.50, 0.002, 0.010), 0.35, (0.20, 0.13, 0.12), 11, 0.23)
    material("Paint silver", (0.42, 0.43, 0.445), 0.38, (0.26, 0.265, 0.27), 12, 0.30)
    material("Paint green", (0.006, 0.125, 0.070), 0.50, (0.12, 0.34, 0.22), 14, 0.26)


def glass(material):
    # Everything of a pane is multiplied by alpha, its reflection too.
    material("Glass clear", (0.02, 0.03, 0.028), 0.5, 0.5, 400, 0.40, alpha=0.20)
    material("Glass tinted", (0.012, 0.015, 0.016), 0.5, 0.5, 400, 0.26, alpha=0.54)
    material("Mirror", 0.03, 0.5, reflectivity=0.95)


def trim(material):
    material("Black trim", 0.040, OUTSIDE, 0.16, 40, 0.10)
    material("Plastic black", (0.122, 0.123, 0.125), 0.36, 0.12, 10)
    material("Plastic grey", (0.27, 0.275, 0.28), OUTSIDE, 0.10, 14)
    material("Rubber", (0.068, 0.068, 0.070), OUTSIDE, 0.07, 6)
    material("Belt rubber", (0.060, 0.060, 0.062), HIDDEN, 0.10, 9)
    material("Underbody", (0.160, 0.160, 0.165), 0.40, 0.05, 6)


def metals(material):
    material("Chrome", (0.46, 0.47, 0.48), 0.4, 0.7, 120, 0.82)
    material("Alloy", (0.47, 0.48, 0.50), OUTSIDE, 0.40, 22, 0.34)
    material("Alloy dark", (0.13, 0.135, 0.145), OUTSIDE, 0.35, 26, 0.22)
    material("Aluminium", (0.53, 0.535, 0.54), INSIDE, 0.28, 14, 0.12)
    material("Steel", (0.29, 0.315, 0.35), INSIDE, 0.45, 30, 0.14)
    material("Cast iron", (0.200, 0.170, 0.150), INSIDE, 0.10, 9)
    material("Copper", (0.60, 0.27, 0.12), INSIDE, (0.4, 0.25, 0.15), 24, 0.10)
    material("Brake disc", (0.36, 0.36, 0.37), INSIDE, 0.40, 18, 0.14)
    material("Brake caliper", (0.16, 0.16, 0.165), INSIDE, 0.18, 16, 0.03)


def lamps(material):
    material("Lamp glass", (0.05, 0.055, 0.06), 0.5, 0.6, 400, 0.80, alpha=0.11)
    material("Lamp clear", (0.36, 0.38, 0.41), 0.35, 0.6, 200, 0.30, alpha=0.42)
    material("Lamp red", (0.22, 0.0, 0.008), 0.45, (0.5, 0.25, 0.25), 200, 0.16, alpha=0.90)
    material("Lamp amber", (0.62, 0.20, 0.0), 0.40, (0.5, 0.4, 0.3), 200, 0.16, alpha=0.86)
    material("Reflector", (0.56, 0.57, 0.58), 0.5, 0.6, 90, 0.72)
    material("Bulb", (0.30, 0.30, 0.28), 0.5, 0.5, 90, emission=[0.62, 0.60, 0.52, 1])
    material("Bulb amber", (0.50, 0.24, 0.02), 0.5, 0.5, 90, emission=[0.30, 0.12, 0.0, 1])


def interior(material):
    material("Plastic grain", (0.135, 0.136, 0.140), INSIDE, 0.06, 8)
    material("Piano black", 0.02, INSIDE, 0.30, 160, 0.14)
    material("Dash silver", (0.43, 0.435, 0.445), INSIDE, 0.32, 20, 0.10)
    material("Seat cloth", 0.2, (0.045, 0.045, 0.048), 0.02, 4, image="textures/cloth.png")
    material("Seat bolster", (0.120, 0.122, 0.130), INSIDE, 0.03, 5)
    material("Carpet", (0.180, 0.178, 0.176), 0.42)
    material("Boot carpet", (0.205, 0.205, 0.210), 0.32)
    material("Headliner", (0.50, 0.485, 0.455), INSIDE)
    material("Leather", (0.115, 0.113, 0.112), INSIDE, 0.14, 16, 0.03)
    material("Belt strap", (0.085, 0.085, 0.088), INSIDE, 0.06, 10)


def printed(material):
    # A picture replaces the diffuse colour only. Those to be read without light too have their brightness as alpha:
    # black must be behind.
    for name, image in (("Dials", "dials"), ("Screen", "screen")):
        material(name, 0.5, 0.0, emission=[0.28, 0.31, 0.34, 1], image=f"textures/{image}.png")
    for name in ("Plate front", "Plate rear"):
        material(name, 0.9, 0.06, 0.08, 20, image="textures/plate.png")
    material("Badge", 0.7, 0.14, 0.3, 90, 0.12, image="textures/badge.png")
    material("Floor shadow", 0.0, 0.0, image="textures/floor_shadow.png")


def backgrounds(material):
    material("Background light grey", (0.82, 0.835, 0.85), 0.0)
    material("Background hall", 1.0, 0.0, image="textures/hall.png")
