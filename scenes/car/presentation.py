"""What the car is shown in: lights, cameras, backgrounds and its shadow on the floor."""

import math

from authoring import Cage, cap


def pointed(eye, focus):
    """The matrix of a light at `eye`, row by row: it shines along its own -z, towards `focus`."""
    def unit(v):
        length = math.sqrt(sum(c * c for c in v))
        return [c / length for c in v]

    def cross(a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

    z = unit([e - f for e, f in zip(eye, focus)])
    x = unit(cross((0, 1, 0) if abs(z[1]) < 0.99 else (0, 0, 1), z))
    y = cross(z, x)
    return [[x[i], y[i], z[i], eye[i]] for i in range(3)] + [[0, 0, 0, 1]]


def add(car):
    car.numbered_from(900)
    group = car.group("Presentation", presentation=True)
    lights(car, car.group("Lights", group))
    cameras(car, car.group("Cameras", group))
    backgrounds(car, car.group("Backgrounds", group))
    car.part("Floor shadow", group, floor_shadow(), "Floor shadow")


def floor_shadow():
    """A flat sheet of 2.4 x 5 m about the car, with round corners as its picture's."""
    half_width, half_length, radius = 1.2, 2.5, 0.75
    border = []
    for side_x, side_z, first in ((1, 1, 0), (-1, 1, 90), (-1, -1, 180), (1, -1, 270)):
        for k in range(5):
            angle = math.radians(first + 22.5 * k)
            border.append((side_x * (half_width - radius) + radius * math.cos(angle), 0.001,
                           side_z * (half_length - radius) + radius * math.sin(angle)))
    sheet = Cage(border[::-1])
    vertices = list(sheet.mesh.verts)
    return cap(sheet, vertices[15:] + vertices[:15]).crease().texture(lambda p: (0.5 - p.x / 2.4, 0.5 + p.z / 5))


def lights(car, group):
    """One shines at a time: each has to show the car by itself."""
    target = (0, 0.6, 0)
    car.node("light", "Key", group, pointed((5.0, 3.6, 4.4), target), lightType="point", color=[1.08, 1.06, 1.02, 1])
    car.node("light", "Fill", group, pointed((1.4, 3.6, 4.8), target), lightType="directional",
             color=[0.84, 0.92, 1.04, 1])
    car.node("light", "Rim", group, pointed((5.6, 4.0, -3.6), target), lightType="point", color=[1.06, 1.0, 0.92, 1])
    car.node("light", "Ceiling", group, pointed((2.4, 5.6, 4.4), (0, 0.5, 0.2)), lightType="spot", angle=46,
             color=[1.1, 1.1, 1.1, 1])


def cameras(car, group):
    """The first is where a viewer starts."""
    car.node("camera", "Outside", group, eye=[4.2, 1.5, 4.9], focus=[0.02, 0.64, 0.12], fov=28)
    car.node("camera", "Driver's seat", group, eye=[0.36, 1.17, -0.20], focus=[0.29, 1.0, 0.8], fov=65, look=0.6)


def backgrounds(car, group):
    """The first is shown at the start."""
    faces = [f"textures/{face}.png" for face in ("px", "nx", "py", "ny", "pz", "nz")]
    car.node("background", "Studio", group, cubeMap=faces)
    car.node("background", "Light grey", group, material="Background light grey")
    car.node("background", "Hall", group, material="Background hall")
