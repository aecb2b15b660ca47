# Makes Blender's lights and environment.
import math

import bpy
from exported import load_image
from mathutils import Matrix, Vector
from nodes import WHITE, Nodes, rgba, set_where_known


def undo_spot_cosine(data, direction):
    """Removes the cosine falloff of Cycles' spot light within its cone, which Duet's does not have."""
    nodes = Nodes(data)
    incoming = nodes.add("ShaderNodeNewGeometry", "Incoming")
    cosine = nodes.math("ABSOLUTE", nodes.dot(incoming, direction))
    light = nodes.add("ShaderNodeEmission", 0, {}, Color=WHITE, Strength=nodes.math("DIVIDE", 1.0, cosine))
    nodes.output("ShaderNodeOutputLight", Surface=light)


def make_light(light, number):
    data = bpy.data.lights.new(f"light {number}", {"point": "POINT", "spot": "SPOT", "sun": "SUN"}[light["type"]])
    strength = max(light["color"])
    data.color = [c / strength for c in light["color"]]
    data.energy = strength if light["type"] == "sun" else 4 * math.pi * strength
    if light["type"] == "sun":
        data.angle = 0.0
    else:
        data.shadow_soft_size = 0.0
        set_where_known(False, "use_soft_falloff", data)
    if light["type"] == "spot":
        data.spot_size = 2 * math.acos(light["cos_outer"])
        data.spot_blend = (light["cos_inner"] - light["cos_outer"]) / (1 - light["cos_outer"])
        undo_spot_cosine(data, light["direction"])
    thing = bpy.data.objects.new(data.name, data)
    bpy.context.collection.objects.link(thing)
    turn = Vector(light.get("direction", (0, 0, -1))).to_track_quat("-Z", "Y").to_matrix().to_4x4()
    thing.matrix_world = Matrix.Translation(light.get("position", (0, 0, 0))) @ turn
    set_where_known(1024, "max_bounces", data.cycles)


def make_environment(e):
    """Returns the nodes of the environment."""
    world = bpy.data.worlds.new("environment")
    bpy.context.scene.world = world
    nodes = Nodes(world)
    if e["type"] == "constant":
        color = rgba(e["radiance"])
    else:
        direction = nodes.add("ShaderNodeTexCoord", "Generated")
        if e["type"] == "sky":
            height = nodes.math("MULTIPLY_ADD", nodes.dot(direction, (0.0, 1.0, 0.0)), 0.5, 0.5)
            color = nodes.mix(height, rgba(e["down"]), rgba(e["up"]))
        else:
            turned = nodes.add("ShaderNodeCombineXYZ", 0, {},
                               **{axis: nodes.dot(direction, row) for axis, row in zip("XYZ", e["rows"])})
            color = nodes.add("ShaderNodeTexEnvironment", 0,
                              {"image": load_image(e["file"]), "interpolation": "Linear"}, Vector=turned)
    background = nodes.add("ShaderNodeBackground", 0, {}, Color=color, Strength=e.get("scale", 1.0))
    nodes.output("ShaderNodeOutputWorld", Surface=background)
    return nodes
