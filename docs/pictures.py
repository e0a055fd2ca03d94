"""The pages of the gallery as pictures: `python docs/pictures.py [NAME ...]`, or all of them.

Each page is written by its command, into out/pictures, and photographed by Chromium: on a desk and
on a phone, in light and dark. A page that is there already is only photographed.
"""

from __future__ import annotations

import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from PIL import Image, ImageChops

ROOT = Path(__file__).parents[1]
PROGRAM = Path(sys.executable).with_name("rr-opt")
FOLDER = ROOT / "out" / "pictures"
RECORDED = (
    "record --engine planar --gait '0.5, 1 s' --gait '0.6, 1.2 s, 10 deg' "
    "--gait '0.5, 1.1 s, -8 deg, rest' --gait '0.7, 1.4 s, 5 deg' "
    "--gait '0.45, 0.9 s, 5 deg, holdout' "
    "--effect 'coulomb_friction:force1=5 mN,force2=5 mN' --seconds 20 --seed 1"
)
COMMANDS = {
    "maximize-speed": "maximize-speed",
    "turn": "turn --heading '90 deg' --radius 0.5",
    "route": "route problems/routes/around.yaml",
    "study": "study problems/studies/servo.yaml",
    "inspect": "inspect out/pictures/recorded",
    "diagnosis": "diagnose out/pictures/recorded",
    "proof": "prove --cases 2 --seed 1f3a --kinds null",
}
SIZES = {"": (1400, 2400), "-phone": (400, 5000)}
"""px, width and greatest height of a picture: what is below shows more of the same."""

SCHEMES = {"": 1, "-dark": 0}
HEIGHT = 9000
"""px, of the window."""


def run(command: str, out: str) -> None:
    """Gives one command, into the folder `out` of FOLDER."""
    line = [PROGRAM, *shlex.split(command), "--out", FOLDER / out]
    subprocess.run(line, cwd=ROOT, check=True, stdout=subprocess.DEVNULL)


def photographed(page: Path, width: int, scheme: int) -> Image.Image:
    """The page at this width, px, without the empty ground below it."""
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        sys.exit("Chromium is needed: install the package chromium.")
    taken = page.with_name("page.png")
    options = (
        *("--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"),
        f"--user-data-dir={page.with_name('profile')}",
        *(f"--window-size={width},{HEIGHT}", f"--blink-settings=preferredColorScheme={scheme}"),
    )
    line = [chromium, *options, f"--screenshot={taken}", page.as_uri()]
    subprocess.run(line, check=True, capture_output=True, timeout=120)
    picture = Image.open(taken).convert("RGB")
    ground = Image.new("RGB", picture.size, picture.getpixel((1, HEIGHT - 1)))
    box = ImageChops.difference(picture, ground).getbbox() or (0, 0, width, 1)
    return picture.crop((0, 0, width, min(box[3] + 20, HEIGHT)))


def main(names: list[str]) -> None:
    """Writes docs/pages/NAME.png, NAME-dark.png, NAME-phone.png and NAME-phone-dark.png."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    if not (FOLDER / "recorded").exists():
        run(RECORDED, "recorded")
    for name in names or COMMANDS:
        page = FOLDER / name / "report.html"
        if not page.exists():
            run(COMMANDS[name], name)
        for place, (width, most) in SIZES.items():
            for dress, scheme in SCHEMES.items():
                picture = photographed(page, width, scheme)
                picture.save(page.with_name(f"whole{place}{dress}.png"))
                picture = picture.crop((0, 0, width, min(picture.height, most)))
                file = ROOT / "docs" / "pages" / f"{name}{place}{dress}.png"
                picture.quantize(256, Image.Quantize.FASTOCTREE).save(file, optimize=True)
        print(name)


if __name__ == "__main__":
    main(sys.argv[1:])
