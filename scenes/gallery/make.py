"""Draws the gallery: every drawing mode and every teaching scene, with the reference beside it.

    python3 scenes/gallery/make.py PATH/TO/vrut-preview

writes README.md and the pictures that it shows.
"""

import json
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
CAR = os.path.join(SCENES, "car", "car.vrut")
ENGINE, WHEELS = "103", "110"
MARKERS = {"markers": {"Front": {"point": [0, 0.62, 2.16], "text": "Front"},
                       "Hinge": {"point": [0.9, 0.72, 0.8], "text": "Hinge"},
                       "Behind": {"point": [-0.9, 0.6, 0.2], "text": "Behind the car"}}}

MODES = [  # name, what to see, options of render, whether the reference draws it
    ("realistic", "In the materials of the scene, lit from the eye", [], True),
    ("stylized", "Dark blue faces and light blue edges bring out shapes. The reference has the faces only, so that "
                 "the difference is the edges", ["--mode", "stylized"], True),
    ("wireframe", "The edges of all triangles, each once", ["--wireframe"], False),
    ("stylized-wireframe", "Wireframe in the stylized drawing's light blue",
     ["--wireframe", "--mode", "stylized"], False),
    ("selection", "What is selected shows through the car, in an outline: here the engine, under the bonnet",
     ["--select", ENGINE], False),
    ("selection-wireframe", "In wireframe its edges stand out: here the wheels",
     ["--wireframe", "--select", WHEELS], False),
    ("markers", "Markers face the viewer, and fade where something covers them", ["--set", json.dumps(MARKERS)], False),
]

HEAD = """# Gallery

What VRUT Preview draws: first the drawing modes, with the car; then the [teaching scenes](../teaching/README.md), one
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
        self.folder = tempfile.TemporaryDirectory()

    def run(self, *arguments):
        return subprocess.run([self.program, *arguments], check=True, capture_output=True, text=True).stdout

    def render(self, scene, name, size, options):
        """The picture for the page, and losslessly for the comparison."""
        lossless = os.path.join(self.folder.name, name + ".png")
        for output in (lossless, os.path.join(HERE, "pictures", name + ".jpg")):
            self.run("render", scene, "-o", output, "--size", size, "--samples", SAMPLES, "--jpeg-quality", "85", *options)
        return lossless

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
    modes = [gallery.row(name.replace("-", " "), text, "mode-" + name, CAR, "400x250", ["--fov", "24"] + options,
                         with_reference)
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
        file.write(HEAD.format(amplified=AMPLIFIED, samples=SAMPLES) + "\n## Drawing modes\n\n" + table(modes)
                   + "\n## Features\n\n" + table(features))


if __name__ == "__main__":
    main()
