#!/usr/bin/env python3
"""Turns a grid of densities in an OpenVDB file into the raw grid of a medium of type "smoke", and prints that medium.

  vdb_to_smoke.py FILE.vdb OUT.raw [--grid NAME] [--resolution N] [--up y|z]

Where the file's grid is finer than N points along its longest side, blocks of its voxels are averaged. A byte holds the
density of a point: 255 is the largest, and less than 1/510 of it becomes 0. The medium's scattering is that density, so
that a density of 1 in the file scatters all light once per meter; change it to taste. Around the grid is a layer
without density.

It needs OpenVDB's Python module and NumPy (Debian, Ubuntu: python3-openvdb).
"""
import argparse
import json
import os
import sys

LARGEST_RESOLUTION = 255  # with the layer around it, a cube of this side has the most points that the programs accept


def fail(text):
    sys.exit(f"vdb_to_smoke: {text}")


def load_modules():
    """Imports the modules that only a conversion needs, so that --help works without them."""
    global numpy, openvdb
    try:
        import numpy
        try:
            import openvdb  # the module's name since OpenVDB 12
        except ImportError:
            import pyopenvdb as openvdb
    except ImportError as error:
        fail(f"{error}; expected OpenVDB's Python module for {sys.executable} (Debian, Ubuntu: python3-openvdb)")


def read_grid(path, name):
    """Returns the grid of floats of that name. For an empty name, returns the grid named density, or the only one."""
    if not os.path.isfile(path):
        fail(f"{path}: there is no such file")
    try:
        grids = [grid for grid in openvdb.readAllGridMetadata(path) if isinstance(grid, openvdb.FloatGrid)]
        names = [grid.name for grid in grids]
        wanted = name or ("density" if "density" in names else names[0] if len(names) == 1 else "")
        if wanted not in names:
            found = ", ".join(names) or "none"
            fail(f"{path}: found the grids of floats {found}, expected {name or 'one named density'} (see --grid)")
        return openvdb.read(path, wanted)
    except (IOError, RuntimeError, KeyError, ValueError) as error:
        fail(f"{path}: OpenVDB cannot read it: {error}")


def voxel_grid(grid, path, far):
    """Returns the position of voxel (0, 0, 0) and the sides of a voxel, in meters. Fails for a grid that is rotated or
    not linear, because boxes of media are axis-aligned; `far` is a voxel at the end of the grid."""
    origin = numpy.array(grid.transform.indexToWorld((0, 0, 0)))
    axes = [numpy.array(grid.transform.indexToWorld(unit)) - origin for unit in numpy.eye(3).tolist()]
    sides = numpy.array([axes[i][i] for i in range(3)])
    end = numpy.array(grid.transform.indexToWorld(far.tolist()))
    tolerance = 1e-6 * numpy.abs(sides).max() * max(1, numpy.abs(far).max())
    if (not (sides > 0).all() or not numpy.allclose(numpy.array(axes), numpy.diag(sides), atol=tolerance)
            or not numpy.allclose(end, origin + sides * far, atol=tolerance)):
        fail(f"{path}: the grid is turned, mirrored or not linear: expected one along the axes")
    return origin, sides


def averages(grid, low, count, side):
    """Returns the mean densities of blocks of side³ voxels from voxel `low` on: an array of count[0], [1], [2]."""
    means = numpy.zeros(count, dtype=numpy.float64)
    for x in range(count[0]):  # slab by slab, so that a fine grid needs little memory
        slab = numpy.zeros((side, count[1] * side, count[2] * side), dtype=numpy.float32)
        grid.copyToArray(slab, ijk=(low[0] + x * side, low[1], low[2]))
        means[x] = slab.reshape(side, count[1], side, count[2], side).mean(axis=(0, 2, 4), dtype=numpy.float64)
    if not numpy.isfinite(means).all():
        fail("a density is infinite or not a number")
    return numpy.maximum(means, 0)


def write_whole(path, data):
    temporary = f"{path}.{os.getpid()}.tmp"
    try:
        with open(temporary, "wb") as file:
            file.write(data)
        os.replace(temporary, path)
    except OSError as error:
        if os.path.exists(temporary):
            os.remove(temporary)
        fail(f"{path}: cannot be written: {error.strerror}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", metavar="FILE.vdb")
    parser.add_argument("out", metavar="OUT.raw")
    parser.add_argument("--grid", default="", metavar="NAME", help="default: density, or the only grid of floats")
    parser.add_argument("--resolution", type=int, default=128, metavar="N",
                        help=f"points along the longest side, 1 to {LARGEST_RESOLUTION} (default 128)")
    parser.add_argument("--up", choices=["y", "z"], default="y", help="the file's axis that points up (default y)")
    options = parser.parse_args()
    if not 1 <= options.resolution <= LARGEST_RESOLUTION:
        fail(f"--resolution: found {options.resolution}, expected 1 to {LARGEST_RESOLUTION}")

    load_modules()
    grid = read_grid(options.file, options.grid)
    if grid.gridClass == "level set":
        fail(f"{options.file}: the grid {grid.name} holds distances to a surface, expected densities")
    if grid.activeVoxelCount() == 0:
        fail(f"{options.file}: the grid {grid.name} has no density")
    low, high = (numpy.array(corner) for corner in grid.evalActiveVoxelBoundingBox())
    origin, sides = voxel_grid(grid, options.file, high)
    voxels = high - low + 1
    side = int(-(-voxels.max() // options.resolution))
    inner = -(-voxels // side)
    densities = numpy.pad(averages(grid, low.tolist(), tuple(int(n) for n in inner), side), 1)
    # A point lies in the middle of its block.
    first = origin + sides * (low + (side - 1) / 2 - side)
    last = first + sides * side * (numpy.array(densities.shape) - 1)
    if options.up == "z":  # (x, y, z) becomes (x, z, -y)
        densities = numpy.flip(densities.transpose(0, 2, 1), axis=2)
        first, last = (numpy.array([first[0], first[2], -last[1]]), numpy.array([last[0], last[2], -first[1]]))

    largest = float(densities.max())
    if largest == 0:
        fail(f"{options.file}: the grid {grid.name} has no density above 0")
    scaled = numpy.rint(densities * (255 / largest)).astype(numpy.uint8)
    write_whole(options.out, scaled.tobytes(order="F"))  # x varies fastest
    rounded = [[float(f"{x:.9g}") for x in corner] for corner in (first, last)]
    print(json.dumps({"type": "smoke", "low": rounded[0], "high": rounded[1], "scattering": float(f"{largest:.6g}"),
                      "file": os.path.basename(options.out), "resolution": list(scaled.shape)}))


if __name__ == "__main__":
    main()
