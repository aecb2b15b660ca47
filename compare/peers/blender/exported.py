# Reads what compare/peers/export_scene.cpp has written to a folder, which the command line names.
import array
import os
import sys

import bpy

FOLDER, ENGINE = sys.argv[sys.argv.index("--") + 1:]
EEVEE = ENGINE == "eevee"


def read_array(typecode, part):
    """Returns an array from geometry.bin; part is [offset in bytes, count]."""
    values = array.array(typecode)
    with open(os.path.join(FOLDER, "geometry.bin"), "rb") as file:
        file.seek(part[0])
        values.fromfile(file, part[1])
    return values


def load_image(name):
    image = bpy.data.images.load(os.path.join(FOLDER, name))
    image.colorspace_settings.name = "Non-Color"  # the file is linear, with Duet's primaries
    return image
