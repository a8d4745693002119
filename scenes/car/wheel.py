"""The small estate's wheel: it turns about x, and its outer side looks along +x."""

from modelling import bent, box, lathe, turned


def tyre():
    half = [(0.205, 0.078), (0.226, 0.092), (0.256, 0.0975), (0.288, 0.09), (0.31, 0.052)]
    return lathe(half + [(r, -x) for r, x in reversed(half)], 32)


def rim():
    barrel = [(0.206, 0.07), (0.213, 0.083), (0.203, 0.085), (0.192, 0.066), (0.186, -0.075), (0.2, -0.075)]
    hub = [(0, 0.068), (0.04, 0.064), (0.062, 0.05), (0.062, 0.02), (0, 0.02)]
    mesh = lathe(barrel, 28) + lathe(hub, 15, closed=False)

    def spoke(p):  # from the hub outward along y: narrower, and forward, like a dish
        t = (p[1] - 0.045) / 0.15
        return p[0] + 0.042 + 0.024 * t * t, p[1], p[2] * (1 - 0.35 * t)

    bar = bent(box((0.022, 0.15, 0.068), 0.007, (0, 0.12, 0)), spoke)
    for k in range(5):
        mesh += turned(bar, 0, 72 * k)
    return mesh


def brake_disc():
    return lathe([(0.05, 0), (0.05, 0.018), (0.14, 0.018), (0.14, 0)], 20)
