"""demo_picture.py DEMO_FOLDER docs/demo.png: map and view of a demo side by side, under 300 kB.

Needs the package `pillow`.
"""

import pathlib
import sys

from PIL import Image

HEIGHT = 420


def scaled(path):
    picture = Image.open(path).convert("RGB")
    return picture.resize((picture.width * HEIGHT // picture.height, HEIGHT), Image.LANCZOS)


def main(folder, out):
    parts = [scaled(pathlib.Path(folder) / name) for name in ("map.png", "view.png")]
    both = Image.new("RGB", (sum(p.width for p in parts) + 8, HEIGHT), "white")
    both.paste(parts[0], (0, 0))
    both.paste(parts[1], (parts[0].width + 8, 0))
    both.quantize(128, dither=Image.Dither.NONE).save(out, optimize=True)


main(*sys.argv[1:3])
