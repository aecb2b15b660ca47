#!/usr/bin/env python3
"""Measures the peak memory of both programs on scenes of many triangles, instances, lights and pixels.

  python3 tests/memory.py build/release/bin [--scale 0.1]

prints a table in Markdown: for each scene and program the peak memory (resident set), and the bytes for each triangle,
instance, light or pixel, as the growth over a tenth of them. --scale makes all scenes smaller. The largest scene needs
10 GB of memory and 1 GB of disk, and the whole program some minutes.
"""
import argparse
import json
import math
import multiprocessing
import os
import pathlib
import random
import subprocess
import sys
import tempfile

MATERIALS = {"grey": {"type": "diffuse", "albedo": 0.6}, "lamp": {"type": "emissive", "radiance": 5}}
CAMERA = {"eye": [0, 1, 1.5], "look_at": [0, 0, 0]}
SUN = {"type": "sun", "direction": [-1, -2, -1], "irradiance": 3}
FLOOR = {"type": "quad", "corner": [-5, -0.2, 5], "u": [10, 0, 0], "v": [0, 0, -10], "material": "grey"}


def write_sheet(path, triangles):
    """A wavy sheet, as an OBJ file with positions alone."""
    side = max(1, round(math.sqrt(triangles / 2)))
    with open(path, "w", encoding="ascii") as file:
        for j in range(side + 1):
            y = j / side
            file.write("".join(f"v {i / side - 0.5:.6f} {0.05 * math.sin(20 * i / side) * math.cos(17 * y):.6f} "
                               f"{y - 0.5:.6f}\n" for i in range(side + 1)))
        for j in range(side):
            row = range(j * (side + 1) + 1, j * (side + 1) + side + 1)
            file.write("".join(f"f {a} {a + side + 1} {a + 1}\nf {a + 1} {a + side + 1} {a + side + 2}\n" for a in row))
    return 2 * side * side


def triangles(folder, count):
    count = write_sheet(folder / "sheet.obj", count)
    mesh = {"type": "mesh", "file": "sheet.obj", "material": "grey", "normals": "smooth"}
    return count, {"objects": [mesh], "lights": [SUN]}, (640, 360)


def instances(folder, count):
    write_sheet(folder / "leaf.obj", 200)
    leaf = {"type": "group", "name": "leaf", "hidden": True,
            "objects": [{"type": "mesh", "file": "leaf.obj", "material": "grey"}]}
    spread = random.Random(1)
    placed = [{"type": "instance", "of": "leaf",
               "transform": [{"scale": 0.01}, {"translate": [spread.uniform(-1, 1) for _ in range(3)]}]}
              for _ in range(count)]
    return count, {"objects": [leaf] + placed, "lights": [SUN]}, (640, 360)


def lights(_, count):
    spread = random.Random(2)
    placed = [{"type": "sphere", "center": [spread.uniform(-1, 1), spread.uniform(-0.1, 1), spread.uniform(-1, 1)],
               "radius": 0.003, "material": "lamp"} for _ in range(count)]
    return count, {"objects": [FLOOR] + placed}, (640, 360)


def pixels(_, count):
    side = round(math.sqrt(count))
    return side * side, {"objects": [FLOOR], "lights": [SUN]}, (side, side)


SCENES = {"triangles": (triangles, 10**7), "instances": (instances, 10**5), "lights": (lights, 10**4),
          "pixels": (pixels, 9000 * 9000)}


def write_scene(make, folder, count):
    """Writes the scene and returns its count and the size of its image. It runs in a process of its own, because a
    program's peak memory counts the memory of the process that starts it."""
    number, scene, size = make(folder, count)
    scene.update(camera=CAMERA, materials=MATERIALS)
    (folder / "scene.json").write_text(json.dumps(scene))
    return number, size


def peak_bytes(program, scene, size, folder):
    """The peak resident set of a render. os.wait4 returns that of this process alone."""
    arguments = [program, scene, "--size", f"{size[0]}x{size[1]}", "--quiet", "-o", folder / "image.exr"]
    arguments += ["--spp", "1"]
    process = subprocess.Popen(arguments)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"{program} {scene} failed")
    return usage.ru_maxrss * 1024


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path, help="folder of the programs")
    parser.add_argument("--scale", type=float, default=1, help="size of the scenes (default 1)")
    options = parser.parse_args()
    print("| scene | program | peak memory | bytes each |\n|---|---|---|---|")
    for name, (make, largest) in SCENES.items():
        for program in ("raster", "raytrace"):
            results = []
            for count in (0.1 * largest * options.scale, largest * options.scale):
                with tempfile.TemporaryDirectory() as folder:
                    folder = pathlib.Path(folder)
                    with multiprocessing.Pool(1) as writer:
                        number, size = writer.apply(write_scene, (make, folder, round(count)))
                    peak = peak_bytes(options.programs / program, folder / "scene.json", size, folder)
                    results.append((number, peak))
            (few, least), (many, most) = results
            print(f"| {many} {name} | `{program}` | {most / 2**20:.0f} MiB | {(most - least) / (many - few):.0f} |",
                  flush=True)


if __name__ == "__main__":
    main()
