#!/usr/bin/env python3
"""Models the car in Blender and writes its control cages, car.json, beside this file:

    blender --background --python-exit-code 1 --python make_car.py

The same text every time. The program `subdivide` makes the scene from it."""

import os
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)

import body  # noqa: E402
import chassis  # noqa: E402
import interior  # noqa: E402
import materials  # noqa: E402
import presentation  # noqa: E402
import wheels  # noqa: E402
from authoring import Car  # noqa: E402

car = Car("Small estate")
materials.add(car)
doors, boot_lid = body.add(car)
interior.add(car)
interior.door_trims(car, doors)
interior.tailgate_trim(car, *boot_lid)
wheels.add(car)
chassis.add(car)
presentation.add(car)
with open(os.path.join(HERE, "car.json"), "w", encoding="utf-8") as file:
    file.write(car.text())
