# Sets up EEVEE, Blender's rasterizer, up to Blender 4.0: lights in place of emissive surfaces, and light probes.
import math
import statistics

import bpy
from mathutils import Matrix, Vector


def add_lamp(name, shape, radiance, area, place, settings):
    """Adds a light, because EEVEE's emissive surfaces do not light others by themselves. Its power is pi L A by
    Lambert's law."""
    data = bpy.data.lights.new(name, shape)
    strength = max(radiance)
    data.color, data.energy = [c / strength for c in radiance], math.pi * strength * area
    for key, value in settings.items():
        setattr(data, key, value)
    data.use_contact_shadow = True
    thing = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(thing)
    thing.matrix_world = place


def add_lamps(scene, things):
    """Puts a rectangle light in front of each flat emissive mesh, and a spherical light into each other one. Returns
    the meshes, which light probes must not see: they would add the same light once more."""
    emissive = bpy.data.collections.new("emissive")
    bpy.context.scene.collection.children.link(emissive)
    for o, thing in zip(scene["objects"], things):
        used = [scene["materials"][i] for i in o["materials"]]
        if any(m["type"] != "emissive" for m in used) or max(used[0]["radiance"]) == 0.0:
            continue
        emissive.objects.link(thing)
        points = [thing.matrix_world @ v.co for v in thing.data.vertices]
        corners = [[points[v] for v in polygon.vertices] for polygon in thing.data.polygons]
        scaled = [(b - a).cross(c - a) / 2 for a, b, c in corners]
        area = sum(n.length for n in scaled)
        normal = sum(scaled, Vector())
        if normal.length < 0.999 * area:  # not flat
            middle = (least(points) + most(points)) / 2
            radius = max((p - middle).length for p in points)
            add_lamp(o["name"], "POINT", used[0]["radiance"], area, Matrix.Translation(middle),
                     {"shadow_soft_size": radius})
            continue
        normal.normalize()
        along = (corners[0][1] - corners[0][0]).normalized()
        across = normal.cross(along)
        low, high = ([f(axis.dot(p) for p in points) for axis in (along, across)] for f in (min, max))
        center = along * (low[0] + high[0]) / 2 + across * (low[1] + high[1]) / 2 + normal * normal.dot(points[0])
        size = {"shape": "RECTANGLE", "size": high[0] - low[0], "size_y": high[1] - low[1]}
        for side in (1.0, -1.0) if used[0]["two_sided"] else (1.0,):
            turn = Matrix((along, across * -side, normal * -side)).transposed().to_4x4()  # lights shine along -z
            offset = normal * (side * 1e-3 * max(size["size"], size["size_y"]))
            add_lamp(o["name"], "AREA", used[0]["radiance"], area, Matrix.Translation(center + offset) @ turn, size)
    return emissive


def least(points):
    return Vector([min(p[i] for p in points) for i in range(3)])


def most(points):
    return Vector([max(p[i] for p in points) for i in range(3)])


def add_irradiance_grid(boxes, side, hidden):
    """Puts side³ irradiance probes around all objects except a ground much larger than most. `boxes` holds the corners
    of each object's box."""
    sizes = [(most(box) - least(box)).length for box in boxes]
    usual = statistics.median_low(sizes)
    corners = [p for box, size in zip(boxes, sizes) if size <= 20 * usual for p in box]
    probe = bpy.data.lightprobes.new("irradiance", "GRID")
    probe.grid_resolution_x = probe.grid_resolution_y = probe.grid_resolution_z = side
    probe.visibility_collection, probe.invert_visibility_collection = hidden, True
    thing = bpy.data.objects.new("irradiance", probe)
    bpy.context.collection.objects.link(thing)
    half = (most(corners) - least(corners)) / 2 + Vector((1e-3, 1e-3, 1e-3)) * usual
    thing.matrix_world = Matrix.Translation((least(corners) + most(corners)) / 2) @ Matrix.Diagonal((*half, 1.0))


def set_up_eevee(scene, description, things):
    """Switches on the effects that EEVEE has: screen-space reflection, refraction and occlusion, soft shadows, and
    light probes."""
    if bpy.app.version >= (4, 1, 0):
        raise RuntimeError(f"EEVEE of Blender {bpy.app.version_string}: expected one of 3.x or 4.0")
    eevee = scene.eevee
    scene.render.engine = "BLENDER_EEVEE"
    eevee.use_ssr = eevee.use_ssr_refraction = eevee.use_gtao = eevee.use_soft_shadows = True
    eevee.use_ssr_halfres = False
    eevee.shadow_cube_size = eevee.shadow_cascade_size = "2048"
    eevee.light_threshold = 0.0
    # Above this number of polygons, llvmpipe takes minutes to bake light probes.
    many = sum(len(thing.data.polygons) for thing in things) > 500_000
    eevee.gi_cubemap_resolution, eevee.gi_diffuse_bounces = "64", 1 if many else 3
    boxes = [[thing.matrix_world @ Vector(corner) for corner in thing.bound_box] for thing in things]
    corners = [p for box in boxes for p in box]
    reach = (most(corners) - least(corners)).length + max((scene.camera.matrix_world.translation - p).length
                                                          for p in corners)
    data = scene.camera.data
    data.clip_start, data.clip_end = max(data.clip_start, 1e-4 * reach), reach  # EEVEE's depths have 24 bits
    add_irradiance_grid(boxes, 2 if many else 4, add_lamps(description, things))
    bpy.ops.scene.light_cache_bake()
