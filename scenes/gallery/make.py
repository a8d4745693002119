"""Draws the gallery: every drawing mode and every teaching scene, with the reference beside it.

    python3 scenes/gallery/make.py PATH/TO/vrut-preview

writes README.md and the pictures that it shows.
"""

import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
SCENES = os.path.dirname(HERE)
sys.path.insert(0, SCENES)
import png  # noqa: E402

AMPLIFIED = 32
SAMPLES = "8"
MARKERS = {"markers": {"Front": {"point": [0, 0.62, 2.10], "text": "Front"},
                       "Hinge": {"point": [0.86, 0.72, 0.84], "text": "Hinge"},
                       "Behind": {"point": [-0.86, 0.6, 0.2], "text": "Behind the car"}}}

LENGTHWISE = {"sections": {"Lengthwise": {"normal": [1, 0, 0], "distance": 0.3, "hatched": True}}}
CORNER = {"sections": {"Slanting": {"normal": [0.6, 0.8, 0], "distance": 0.8}},
          "sectionBox": {"on": True, "max": [2, 2, 1.2]}}

MODES = [  # name, what to see, options of render (a node by its path in braces), whether the reference draws it
    ("realistic", "In the materials of the scene, lit from the eye", [], True),
    ("stylized", "Dark blue faces and light blue edges bring out shapes", ["--mode", "stylized"], False),
    ("wireframe", "The edges of all triangles, each once", ["--wireframe"], False),
    ("stylized-wireframe", "Wireframe in the stylized drawing's light blue",
     ["--wireframe", "--mode", "stylized"], False),
    ("selection", "What is selected shows through the car, in an outline: here the drive train",
     ["--select", "{Drive train}"], False),
    ("selection-wireframe", "In wireframe its edges stand out: here the wheels",
     ["--wireframe", "--select", "{Wheels}"], False),
    ("section", "A section cuts the scene open: watertight parts are closed by a cap, here hatched; the reference draws no lines",
     ["--set", json.dumps(LENGTHWISE)], True),
    ("section-box", "A box and a plane at once: parts that are not watertight stay open, and show both sides",
     ["--set", json.dumps(CORNER)], True),
    ("markers", "Markers face the viewer, and fade where something covers them", ["--set", json.dumps(MARKERS)], False),
]

SIDES = [  # name, eye
    ("front left", "4.4,1.5,5.2"), ("left", "8.2,1.1,0"), ("rear left", "4.4,1.6,-5.2"), ("rear", "0,1.2,-8"),
    ("rear right", "-4.4,1.6,-5.2"), ("right", "-8.2,1.1,0"), ("front right", "-4.4,1.5,5.2"), ("front", "0,1.1,8"),
]
SEAT = ["--eye", "0.36,1.17,-0.20", "--focus", "0.26,0.98,0.6", "--fov", "68"]
OPENED = {"Body/Doors/Front left": ("y", -62), "Body/Doors/Rear left": ("y", -58), "Body/Doors/Front right": ("y", 62),
          "Body/Doors/Rear right": ("y", 58), "Body/Bonnet": ("x", -48), "Body/Boot lid": ("x", 78)}

HEAD = """# Gallery

What VRUT Preview draws: first the [car](../README.md) from all sides; then the drawing modes; then the [teaching scenes](../teaching/README.md), one
feature each. On the left is the drawing; in the middle the same picture by the reference, which follows each ray in
double precision and takes its time (`render --reference`); on the right their difference, {amplified} times as bright as
it is: black is the same. Where a picture of the reference is missing, it is because the reference draws faces only.

The numbers say how far the two are apart, of 255: the largest difference, and the root of the mean square (RMS), which
rounding to whole numbers alone brings to about 0.3. Large maxima are single pixels at outlines, where a hair's breadth
decides which of two surfaces a sample meets. FLIP (Andersson et al. 2020), from 0 to 1, says how much of it an
eye would notice. All pictures have {samples} samples a pixel.

This page is made by `python3 scenes/gallery/make.py PATH/TO/vrut-preview`.
"""


class Gallery:
    def __init__(self, program):
        self.program = program
        self.car = os.path.join(os.path.dirname(program), os.pardir, "scenes", "car", "car.vrut")
        self.folder = tempfile.TemporaryDirectory()
        self.ids, path = {}, []
        for node in json.loads(self.run("info", self.car, "--json"))["tree"]:
            path[node["depth"]:] = [node["name"]]
            self.ids["/".join(path[1:])] = node["id"]

    def matrix(self, path):
        """A node's own, row by row, as the car's file has it."""
        with open(self.car, encoding="utf-8") as file:
            line = re.search(rf'^node {self.ids[path]} .*\s+matrix ((?:\S+\s+){{16}})', file.read(), re.MULTILINE)
        return [float(number) for number in line.group(1).split()]

    def opened(self, path):
        """Its matrix when it is turned about its hinge."""
        axis, degrees = OPENED[path]
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        x, y, z = self.matrix(path)[3::4][:3]
        turn = [[c, 0, s], [0, 1, 0], [-s, 0, c]] if axis == "y" else [[1, 0, 0], [0, c, -s], [0, s, c]]
        return [*turn[0], x, *turn[1], y, *turn[2], z, 0, 0, 0, 1]

    def chosen(self, switches, child):
        """A patch that shows a child, by number, of all switches whose children are called so."""
        places = {p.rsplit("/", 1)[0]: i for p, i in self.ids.items() if p.rsplit("/", 1)[-1] in switches}
        return {"nodes": {str(self.ids[p]): {"activeChild": child} for p in places}}

    def run(self, *arguments):
        return subprocess.run([self.program, *arguments], check=True, capture_output=True, text=True).stdout

    def render(self, scene, name, size, options):
        """The picture for the page, and losslessly for the comparison."""
        lossless = os.path.join(self.folder.name, name + ".png")
        for output in (lossless, os.path.join(HERE, "pictures", name + ".jpg")):
            self.run("render", scene, "-o", output, "--size", size, "--samples", SAMPLES, "--jpeg-quality", "85", *options)
        return lossless

    def view(self, name, title, options, size="480x270"):
        """A cell: a picture of the car and its title."""
        self.run("render", self.car, "-o", os.path.join(HERE, "pictures", f"car-{name}.jpg"), "--size", size,
                 "--samples", SAMPLES, "--jpeg-quality", "85", *options)
        return f"{picture(f'car-{name}.jpg')}<br>{title}"

    def around(self, eye):
        return ["--eye", eye, "--focus", "0,0.70,0", "--fov", "22"]

    def of_the_car(self):
        sides = [self.view(name.replace(" ", "-"), name, self.around(eye)) for name, eye in SIDES]
        patch = {"nodes": {str(self.ids[p]): {"matrix": self.opened(p)} for p in OPENED}}
        wide = ["--focus", "0,0.75,0", "--fov", "30", "--set", json.dumps(patch)]
        more = [self.view("seat", "from the driver's seat", SEAT),
                self.view("open-front", "doors, bonnet and boot lid open", ["--eye", "4.4,1.9,5.2", *wide]),
                self.view("open-rear", "and from behind", ["--eye", "3.6,1.9,-5.8", *wide]),
                self.view("drive-train", "the drive train, selected",
                          self.around("4.4,1.5,5.2") + ["--select", str(self.ids["Drive train"])])]
        for child, paint in enumerate(("red", "silver", "green")):
            patch = self.chosen(("Red",), child)
            patch["nodes"].update(self.chosen(("Five spokes",), child % 2)["nodes"])
            more.append(self.view("paint-" + paint, f"{paint}, {('five', 'ten')[child % 2]} spokes",
                                  self.around("4.4,1.5,5.2") + ["--set", json.dumps(patch)]))
        more.append(self.view("hall", "before a picture", self.around("4.4,1.5,5.2") + [
            "--background", str(self.ids["Presentation/Backgrounds/Hall"])]))
        return grid(sides) + "\n" + grid(more)

    def row(self, title, text, name, scene, size, options, with_reference=True):
        drawn = self.render(scene, name, size, options)
        cells = [f"**{title}**<br>{text}", picture(name + ".jpg")]
        if not with_reference:
            return cells + ["", "", ""]
        traced = self.render(scene, name + "-reference", size, options + ["--reference"])
        apart = json.loads(self.run("compare", drawn, traced, "--json"))
        amplify(drawn, traced, os.path.join(HERE, "pictures", name + "-difference.png"))
        numbers = f"max {apart['maximum']:.0f}<br>RMS {apart['rms']:.3f}<br>FLIP {apart['flip']['mean']:.4f}"
        return cells + [picture(name + "-reference.jpg"), picture(name + "-difference.png"), numbers]


def picture(file):
    return f"![{os.path.splitext(file)[0].replace('-', ' ')}](pictures/{file})"


def grid(cells, columns=4):
    rows = [cells[i:i + columns] for i in range(0, len(cells), columns)]
    return "\n".join("| " + " | ".join(row) + " |" for row in [[""] * columns, ["---"] * columns] + rows) + "\n"


def amplify(a, b, path):
    """Of each pixel the largest difference of its three colours."""
    width, height, channels, rows = png.read(a)
    others = png.read(b)[3]
    result = []
    for row, other in zip(rows, others):
        off = [min(255, AMPLIFIED * abs(p - q)) for p, q in zip(row, other)]
        result.append(bytes(max(off[i:i + 3]) for i in range(0, width * channels, channels)))
    png.write(path, width, height, 1, result)


def first_sentence(scene):
    """Of the comment on top of a scene."""
    with open(scene, encoding="utf-8") as file:
        lines = file.read().splitlines()[1:]
    comment = []
    for line in lines:
        if not line.startswith("#"):
            break
        comment.append(line[1:].strip())
    return re.split(r"\. |\.$", " ".join(comment))[0]


def table(rows):
    head = ["", "drawing", "reference", f"difference × {AMPLIFIED}", ""]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in [head, ["---"] * 5] + rows) + "\n"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    shutil.rmtree(os.path.join(HERE, "pictures"), ignore_errors=True)
    os.makedirs(os.path.join(HERE, "pictures"))
    gallery = Gallery(sys.argv[1])
    modes = [gallery.row(name.replace("-", " "), text, "mode-" + name, gallery.car, "400x250",
                         [str(gallery.ids[o[1:-1]]) if o[1:-1] in gallery.ids else o for o in options], with_reference)
             for name, text, options, with_reference in MODES]
    teaching = os.path.join(SCENES, "teaching")
    features = []
    with open(os.path.join(teaching, "README.md"), encoding="utf-8") as file:
        names = re.findall(r"^\| \[`([\w-]+)`\]", file.read(), re.MULTILINE)  # in the order in which they are taught
    for name in names:
        scene = os.path.join(teaching, name + ".vrut")
        options, with_reference = [], True
        if name.startswith("light-"):
            options = ["--light", "5"]
        elif name == "selection":
            options, with_reference = ["--select", "3"], False
        features.append(gallery.row(f"[{name}](../teaching/{name}.vrut)", first_sentence(scene), name, scene, "320x240",
                                    options, with_reference))
    with open(os.path.join(HERE, "README.md"), "w", encoding="utf-8", newline="\n") as file:
        file.write(HEAD.format(amplified=AMPLIFIED, samples=SAMPLES) + "\n## The car\n\n" + gallery.of_the_car() + "\n## Drawing modes\n\n"
                   + table(modes)
                   + "\n## Features\n\n" + table(features))


if __name__ == "__main__":
    main()
