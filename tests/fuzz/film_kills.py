#!/usr/bin/env python3
"""Kills renders that keep a film, at random moments, until each is done, and compares the image with that of one run.

  film_kills.py RAYTRACE --kills N --seed S

renders the default scene at 64 x 64 pixels with films written as often as possible. Each image is killed (SIGKILL)
again and again after up to a quarter of a second. Its bits must be those of a run that nobody disturbed. Exit code 1:
some image differs, or a run refused its film.
"""
import argparse
import pathlib
import random
import subprocess
import sys
import tempfile
import time

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("raytrace", help="the program")
parser.add_argument("--kills", type=int, default=1000, help="number of kills, at least (default 1000)")
parser.add_argument("--seed", type=int, default=0, help="seed of the moments")
options = parser.parse_args()

moments = random.Random(options.seed)
scene = str(pathlib.Path(__file__).parents[2] / "models" / "cornell.json")
kills = images = failures = 0
start = time.time()


def command(image, *more):
    return [options.raytrace, scene, "-o", str(image), "--size", "64x64", "--spp", "256", "--quiet", *more]


with tempfile.TemporaryDirectory() as scratch:
    scratch = pathlib.Path(scratch)
    subprocess.run(command(scratch / "whole.pfm"), check=True)
    whole = (scratch / "whole.pfm").read_bytes()
    while kills < options.kills:
        film = scratch / f"{images}.exr"
        image = scratch / f"{images}.pfm"
        while True:
            process = subprocess.Popen(command(image, "--film", str(film), "--film-interval", "0", "--threads", "1"))
            try:
                code = process.wait(timeout=moments.uniform(0, 0.25))
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
                kills += 1
                continue
            if code != 0 or image.read_bytes() != whole:
                failures += 1
                print(f"image {images} after {kills} kills: exit code {code}, other bits", file=sys.stderr)
            break
        images += 1
        film.unlink(missing_ok=True)
print(f"{kills} kills, {images} images in {time.time() - start:.0f} s: {failures} failures")
sys.exit(failures > 0)
