# Makes Blender's volumes of media: boxes of constant density, boxes of a grid of densities, and all of space.
import os
import sys

import bpy
from exported import FOLDER, read_array
from nodes import Nodes, rgba


def volume_shader(nodes, medium, density):
    """Returns the shader of a medium, whose density is a number or an output of a node."""
    scattering, absorption = medium["scattering"], medium["absorption"]
    glow = [a * r for a, r in zip(absorption, medium["radiance"])]
    shaders = []
    if max(scattering) > 0.0:
        color = rgba([s / max(scattering) for s in scattering])
        shaders.append(nodes.add("ShaderNodeVolumeScatter", 0, {}, Color=color, Anisotropy=medium["asymmetry"],
                                 Density=nodes.math("MULTIPLY", density, max(scattering))))
    if max(absorption) > 0.0:  # Blender's coefficient is (1 - color)*density
        color = rgba([1.0 - a / max(absorption) for a in absorption])
        shaders.append(nodes.add("ShaderNodeVolumeAbsorption", 0, {}, Color=color,
                                 Density=nodes.math("MULTIPLY", density, max(absorption))))
    if max(glow) > 0.0:
        shaders.append(nodes.add("ShaderNodeEmission", 0, {}, Color=rgba([g / max(glow) for g in glow]),
                                 Strength=nodes.math("MULTIPLY", density, max(glow))))
    return nodes.sum(shaders)


def make_box(name, low, high):
    """Makes a box that is a little larger, because Cycles loses surfaces that coincide with its sides."""
    mesh = bpy.data.meshes.new(name)
    sides = [(a - 1e-4 * (b - a), b + 1e-4 * (b - a)) for a, b in zip(low, high)]
    corners = [(x, y, z) for x in sides[0] for y in sides[1] for z in sides[2]]
    mesh.from_pydata(corners, [], [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    return mesh


def make_grid(name, low, high, density):
    """Writes the grid as a file of OpenVDB, which is the only kind that Blender reads."""
    # Blender looks for modules beside the python3 in PATH, which may be another than Debian's.
    sys.path.append("/usr/lib/python3/dist-packages")
    try:
        import pyopenvdb
    except ModuleNotFoundError as error:
        raise RuntimeError("grids need pyopenvdb (Debian, Ubuntu: apt-get install python3-openvdb)") from error
    size = density["size"]
    grid = pyopenvdb.FloatGrid()
    grid.name = "density"
    points = grid.getAccessor()
    for i, value in enumerate(read_array("f", density["values"])):
        if value > 0.0:
            points.setValueOn((i % size[0], i // size[0] % size[1], i // (size[0] * size[1])), value)
    step = [(b - a) / (n - 1) for a, b, n in zip(low, high, size)]
    # Cycles places each density halfway between a point of the grid and the next one. The grid is shifted back by that.
    first = [a - 0.5 * s for a, s in zip(low, step)]
    grid.transform = pyopenvdb.createLinearTransform(
        [[step[0], 0, 0, 0], [0, step[1], 0, 0], [0, 0, step[2], 0], [*first, 1]])
    volume = bpy.data.volumes.new(name)
    volume.filepath = os.path.join(FOLDER, f"{name}.vdb")
    pyopenvdb.write(volume.filepath, grids=[grid])
    return volume


def make_box_medium(name, medium):
    material = bpy.data.materials.new(name)
    nodes = Nodes(material)
    varies = medium["density"] is not None
    density = nodes.add("ShaderNodeAttribute", "Fac", {"attribute_name": "density"}) if varies else 1.0
    nodes.output("ShaderNodeOutputMaterial", Volume=volume_shader(nodes, medium, density))
    material.cycles.homogeneous_volume = not varies
    low, high = medium["box"]
    shape = make_grid(name, low, high, medium["density"]) if varies else make_box(name, low, high)
    shape.materials.append(material)
    bpy.context.collection.objects.link(bpy.data.objects.new(name, shape))


def make_media(media, environment):
    """Makes volumes of the media. Media without a box are in the world of Blender, whose nodes are `environment`."""
    everywhere = [volume_shader(environment, medium, 1.0) for medium in media if medium["box"] is None]
    if everywhere:
        environment.output("ShaderNodeOutputWorld", Volume=environment.sum(everywhere))
        bpy.context.scene.world.cycles.homogeneous_volume = True
    for number, medium in enumerate(media):
        if medium["box"] is not None:
            make_box_medium(f"medium {number}", medium)
