# Builds the scene that compare/peers/export_scene.cpp wrote in Blender, then renders it on each request with Cycles,
# Blender's path tracer, or with EEVEE, its rasterizer.
# Run by compare/peers/blender.cpp: blender -b --factory-startup --debug-cycles --python blender.py -- FOLDER ENGINE
# The scene's coordinates are used in Blender without rotation, with y up.
# The script supports Blender 3.x and 4.x, and EEVEE up to 4.0. Where their names differ, a tuple lists the
# alternatives, and the first that exists is used.
import array
import json
import math
import os
import statistics
import sys
import time

import bpy
from mathutils import Matrix, Vector

FOLDER, ENGINE = sys.argv[sys.argv.index("--") + 1:]
EEVEE = ENGINE == "eevee"
WHITE = (1.0, 1.0, 1.0, 1.0)
GLOSSY = ("ShaderNodeBsdfGlossy", "ShaderNodeBsdfAnisotropic")  # since 4.0, the second name is for both
SHARP = ("SHARP", "GGX")  # since 4.0, a roughness of 0 is used instead of SHARP


def first_known(owner, name, *values):
    """Sets a property to the first of the values that this version of Blender supports."""
    for value in values:
        try:
            setattr(owner, name, value)
            return
        except TypeError:
            pass
    raise RuntimeError(f"Blender {bpy.app.version_string}: {name} can be none of {', '.join(map(str, values))}")


def set_where_known(value, name, *owners):
    """Sets a property of the first owner that has it; none if newer versions have removed it."""
    for owner in owners:
        if hasattr(owner, name):
            setattr(owner, name, value)
            return


def rgba(color):
    return (color[0], color[1], color[2], 1.0)


def read_array(typecode, part):
    """Returns an array from geometry.bin; part is [offset in bytes, count]."""
    values = array.array(typecode)
    with open(os.path.join(FOLDER, "geometry.bin"), "rb") as file:
        file.seek(part[0])
        values.fromfile(file, part[1])
    return values


class Nodes:
    """A node tree that is built bottom-up: add(...) returns an output socket."""

    def __init__(self, owner):
        owner.use_nodes = True
        self.tree = owner.node_tree
        self.tree.nodes.clear()

    def add(self, kind, output=0, settings=None, **inputs):
        node = self.new_node(kind)
        for name, value in (settings or {}).items():
            first_known(node, name, *(value if isinstance(value, tuple) else (value,)))
        for name, value in inputs.items():
            key = int(name[1:]) if name[0] == "_" and name[1:].isdigit() else name.replace("_", " ")
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, node.inputs[key])
            else:
                node.inputs[key].default_value = value
        return node.outputs[output]

    def new_node(self, kind):
        kinds = kind if isinstance(kind, tuple) else (kind,)
        for kind in kinds:
            if hasattr(bpy.types, kind):
                return self.tree.nodes.new(kind)
        raise RuntimeError(f"Blender {bpy.app.version_string} has no node {' or '.join(kinds)}")

    def math(self, operation, *values):
        return self.add("ShaderNodeMath", 0, {"operation": operation}, **{f"_{i}": v for i, v in enumerate(values)})

    def dot(self, a, b):
        return self.add("ShaderNodeVectorMath", "Value", {"operation": "DOT_PRODUCT"}, _0=a, _1=b)

    def mix(self, factor, a, b):
        return self.add("ShaderNodeMixRGB", 0, {}, Fac=factor, Color1=a, Color2=b)

    def multiply(self, a, b):
        return self.add("ShaderNodeMixRGB", 0, {"blend_type": "MULTIPLY"}, Fac=1.0, Color1=a, Color2=b)


def load_image(name):
    image = bpy.data.images.load(os.path.join(FOLDER, name))
    image.colorspace_settings.name = "Non-Color"  # the file is linear, with Duet's primaries
    return image


def texture(nodes, t):
    uv = nodes.add("ShaderNodeUVMap", 0, {"uv_map": "uv"})
    if t["type"] == "image":
        scaled = nodes.add("ShaderNodeVectorMath", 0, {"operation": "MULTIPLY"}, _0=uv,
                           _1=(t["scale"][0], t["scale"][1], 1.0))
        settings = {"image": load_image(t["file"]), "interpolation": "Linear" if t["bilinear"] else "Closest"}
        return nodes.add("ShaderNodeTexImage", "Color", settings, Vector=scaled)
    place = nodes.add("ShaderNodeAttribute", "Vector", {"attribute_name": "p_object"}) if t["solid"] else uv
    # Cycles' checker is three-dimensional. It uses Color2 where the sum of the cell indices is even.
    shift = 1.0 / 4096 if t["solid"] else 0.0
    moved = nodes.add("ShaderNodeVectorMath", 0, {"operation": "MULTIPLY_ADD"}, _0=place, _1=(t["scale"],) * 3,
                      _2=(shift,) * 3)
    return nodes.add("ShaderNodeTexChecker", "Color", {}, Vector=moved, Scale=1.0, Color1=rgba(t["odd"]),
                     Color2=rgba(t["even"]))


def slot(nodes, s):
    if s["texture"] is None:
        return rgba(s["value"])
    return nodes.multiply(texture(nodes, s["texture"]), rgba(s["value"]))


def metal(nodes, m):
    # This is Schlick's Fresnel term at the shading normal, which is exact for a mirror.
    geometry = nodes.tree.nodes.new("ShaderNodeNewGeometry")
    cosine = nodes.math("ABSOLUTE", nodes.dot(geometry.outputs["Incoming"], geometry.outputs["Normal"]))
    grazing = nodes.math("POWER", nodes.math("SUBTRACT", 1.0, cosine), 5.0)
    color = nodes.mix(grazing, slot(nodes, m["slot"]), WHITE)
    smooth = m["roughness"] ** 2 < 1e-4
    # In Blender, too, alpha is the square of the roughness. Duet's metal includes multiple scattering, as MULTI_GGX.
    return nodes.add(GLOSSY, 0, {"distribution": SHARP if smooth else "MULTI_GGX"}, Color=color,
                     Roughness=0.0 if smooth else m["roughness"])


def clear_glass(m):
    return m["slot"]["texture"] is None and all(channel == 1.0 for channel in m["slot"]["value"])


def dielectric(nodes, m):
    # Blender's rough glass matches Duet's: it has the Fresnel term at the microfacet and conserves energy. But it also
    # tints reflections, so it is used for clear glass only.
    rough = m["roughness"]
    if rough > 0 and clear_glass(m):
        return nodes.add("ShaderNodeBsdfGlass", 0, {"distribution": "MULTI_GGX"}, Color=WHITE, IOR=m["ior"],
                         Roughness=rough)
    lobe = {"distribution": "GGX" if rough > 0 else SHARP}
    through = nodes.add("ShaderNodeBsdfRefraction", 0, lobe, Color=slot(nodes, m["slot"]), IOR=m["ior"],
                        Roughness=rough)
    back = nodes.add(GLOSSY, 0, lobe, Color=WHITE, Roughness=rough)
    return nodes.add("ShaderNodeMixShader", 0, {}, Fac=nodes.add("ShaderNodeFresnel", 0, {}, IOR=m["ior"]), _1=through,
                     _2=back)


def absorption(nodes, m):
    # Blender's absorption coefficient is (1 - color)*density.
    sigma = m.get("absorption", (0.0, 0.0, 0.0))
    density = max(sigma)
    if density == 0.0:
        return None
    return nodes.add("ShaderNodeVolumeAbsorption", 0, {}, Color=rgba([1.0 - s / density for s in sigma]),
                     Density=density)


def principled(nodes, m):
    # In Blender, specular 0.5 means a reflectance of 0.04 at normal incidence.
    normal = ((m["ior"] - 1.0) / (m["ior"] + 1.0)) ** 2
    inputs = {"Base_Color": slot(nodes, m["slot"]), "Metallic": m["metallic"], "Roughness": m["roughness"]}
    if bpy.app.version < (4, 0, 0):
        # Blender's coat is a quarter of a coat with index 1.5. Values above 1 are only possible through a link.
        coat = nodes.math("MULTIPLY", 4.0, m["clearcoat"]) if m["clearcoat"] > 0.0 else 0.0
        inputs |= {"Specular": normal / 0.08, "Clearcoat": coat, "Clearcoat_Roughness": m["clearcoat_roughness"]}
    else:
        inputs |= {"IOR": m["ior"], "Coat_Weight": m["clearcoat"], "Coat_Roughness": m["clearcoat_roughness"]}
    properties = {"distribution": "MULTI_GGX"}
    if "subsurface" in m:
        weight, radius = m["subsurface"]["weight"], m["subsurface"]["radius"]
        properties["subsurface_method"] = "RANDOM_WALK"
        if bpy.app.version < (4, 0, 0):
            inputs |= {"Subsurface": weight, "Subsurface_Color": slot(nodes, m["slot"]), "Subsurface_Radius": radius}
        else:
            inputs |= {"Subsurface_Weight": weight, "Subsurface_Radius": radius, "Subsurface_Scale": 1.0}
    return nodes.add("ShaderNodeBsdfPrincipled", 0, properties, **inputs)


def emissive(nodes, m):
    strength = 1.0
    if not m["two_sided"]:
        strength = nodes.math("SUBTRACT", 1.0, nodes.add("ShaderNodeNewGeometry", "Backfacing"))
    light = nodes.add("ShaderNodeEmission", 0, {}, Color=rgba(m["radiance"]), Strength=strength)
    if m["slot"]["texture"] is None and not any(m["slot"]["value"]):
        return light
    reflected = nodes.add("ShaderNodeBsdfDiffuse", 0, {}, Color=slot(nodes, m["slot"]), Roughness=0.0)
    return nodes.add("ShaderNodeAddShader", 0, {}, _0=light, _1=reflected)


def diffuse(nodes, m):
    return nodes.add("ShaderNodeBsdfDiffuse", 0, {}, Color=slot(nodes, m["slot"]), Roughness=0.0)


def make_material(m):
    material = bpy.data.materials.new(m["name"])
    nodes = Nodes(material)
    surface = {"diffuse": diffuse, "metal": metal, "dielectric": dielectric, "principled": principled,
               "emissive": emissive}[m["type"]](nodes, m)
    output = nodes.tree.nodes.new("ShaderNodeOutputMaterial")
    nodes.tree.links.new(surface, output.inputs["Surface"])
    if EEVEE:
        material.use_screen_refraction = m["type"] == "dielectric"
        if m["type"] == "emissive":
            material.shadow_method = "NONE"  # the light that stands for it would be in its shadow
    inside = absorption(nodes, m)
    if inside is not None:
        nodes.tree.links.new(inside, output.inputs["Volume"])
    return material


def make_mesh(name, part):
    mesh = bpy.data.meshes.new(name)
    positions, triangles = read_array("f", part["positions"]), read_array("i", part["triangles"])
    count = len(triangles) // 3
    mesh.vertices.add(len(positions) // 3)
    mesh.vertices.foreach_set("co", positions)
    mesh.loops.add(3 * count)
    mesh.loops.foreach_set("vertex_index", triangles)
    mesh.polygons.add(count)
    mesh.polygons.foreach_set("loop_start", array.array("i", range(0, 3 * count, 3)))
    if bpy.app.version < (3, 6):  # later versions derive it from loop_start
        mesh.polygons.foreach_set("loop_total", array.array("i", [3]) * count)
    mesh.polygons.foreach_set("material_index", read_array("i", part["slots"]))
    mesh.polygons.foreach_set("use_smooth", array.array("b", [1 if part["normals"] else 0]) * count)
    if part["uvs"]:
        mesh.uv_layers.new(name="uv").data.foreach_set("uv", read_array("f", part["uvs"]))
    if part["p_object"]:
        mesh.attributes.new("p_object", "FLOAT_VECTOR", "CORNER").data.foreach_set("vector",
                                                                                   read_array("f", part["p_object"]))
    mesh.update(calc_edges=True)
    if part["normals"]:
        normals = read_array("f", part["normals"])
        set_where_known(True, "use_auto_smooth", mesh)  # since 4.1, the corners' normals are always used
        mesh.normals_split_custom_set([normals[i:i + 3] for i in range(0, len(normals), 3)])
    if len(mesh.polygons) != count:
        raise RuntimeError(f"{name}: Blender made {len(mesh.polygons)} of {count} triangles")
    return mesh


def make_objects(scene, materials):
    """Returns Blender's objects, in the order of the scene's."""
    meshes = [make_mesh(part["name"], part) for part in scene["meshes"]]
    things = []
    for o in scene["objects"]:
        mesh = meshes[o["mesh"]]
        while len(mesh.materials) < len(o["materials"]):
            mesh.materials.append(None)
        thing = bpy.data.objects.new(o["name"], mesh)
        things.append(thing)
        bpy.context.collection.objects.link(thing)
        for i, index in enumerate(o["materials"]):
            thing.material_slots[i].link = "OBJECT"
            thing.material_slots[i].material = materials[index]
        thing.matrix_world = Matrix(o["matrix"])
        set_where_known(0.0, "shadow_terminator_offset", thing.cycles)
        set_where_known(0.0, "shadow_terminator_normal_offset", thing)
        set_where_known(0.0, "shadow_terminator_geometry_offset", thing.cycles, thing)
    return things


def undo_spot_cosine(data, direction):
    """Removes the cosine falloff of Cycles' spot light within its cone, which Duet's does not have."""
    nodes = Nodes(data)
    incoming = nodes.add("ShaderNodeNewGeometry", "Incoming")
    cosine = nodes.math("ABSOLUTE", nodes.dot(incoming, direction))
    light = nodes.add("ShaderNodeEmission", 0, {}, Color=WHITE, Strength=nodes.math("DIVIDE", 1.0, cosine))
    nodes.tree.links.new(light, nodes.tree.nodes.new("ShaderNodeOutputLight").inputs["Surface"])


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
    output = nodes.tree.nodes.new("ShaderNodeOutputWorld")
    nodes.tree.links.new(background, output.inputs["Surface"])


def make_camera(c):
    data = bpy.data.cameras.new("camera")
    data.sensor_fit = "VERTICAL"
    data.clip_start, data.clip_end = max(c["near"], 1e-6), 1e9
    if c["orthographic"]:
        data.type, data.ortho_scale = "ORTHO", c["height"]
    else:
        data.lens_unit = "FOV"
        data.angle = math.radians(c["fov_degrees"])
    if c["aperture_radius"] > 0:
        data.dof.use_dof = True
        data.dof.focus_distance = c["focus_distance"]
        data.dof.aperture_fstop = 1e-3 * data.lens / (2 * c["aperture_radius"])
    thing = bpy.data.objects.new("camera", data)
    bpy.context.collection.objects.link(thing)
    thing.matrix_world = Matrix(c["matrix"])
    bpy.context.scene.camera = thing


def add_lamp(name, shape, radiance, area, place, settings):
    """Adds a light of EEVEE, whose surfaces do not light others by themselves. Lambert's law: power = pi L A."""
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
    """Puts a rectangle in front of each flat emissive mesh, and a ball into each other. Returns the meshes, which light
    probes must not see: they would give the same light once more."""
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
            turn = Matrix((along, across * -side, normal * -side)).transposed().to_4x4()  # it shines along its -z
            offset = normal * (side * 1e-3 * max(size["size"], size["size_y"]))
            add_lamp(o["name"], "AREA", used[0]["radiance"], area, Matrix.Translation(center + offset) @ turn, size)
    return emissive


def least(points):
    return Vector([min(p[i] for p in points) for i in range(3)])


def most(points):
    return Vector([max(p[i] for p in points) for i in range(3)])


def add_irradiance_grid(boxes, side, hidden):
    """Puts side³ irradiance probes around all objects but a ground much larger than most; boxes are their corners."""
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
    """Switches on what EEVEE has: screen-space reflection, refraction and occlusion, soft shadows, and light probes."""
    if bpy.app.version >= (4, 1, 0):
        raise RuntimeError(f"EEVEE of Blender {bpy.app.version_string}: expected one of 3.x or 4.0")
    eevee = scene.eevee
    scene.render.engine = "BLENDER_EEVEE"
    eevee.use_ssr = eevee.use_ssr_refraction = eevee.use_gtao = eevee.use_soft_shadows = True
    eevee.use_ssr_halfres = False
    eevee.shadow_cube_size = eevee.shadow_cascade_size = "2048"
    eevee.light_threshold = 0.0
    # With more than this llvmpipe bakes light probes for minutes.
    many = sum(len(thing.data.polygons) for thing in things) > 500_000
    eevee.gi_cubemap_resolution, eevee.gi_diffuse_bounces = "64", 1 if many else 3
    boxes = [[thing.matrix_world @ Vector(corner) for corner in thing.bound_box] for thing in things]
    corners = [p for box in boxes for p in box]
    reach = (most(corners) - least(corners)).length + max((scene.camera.matrix_world.translation - p).length
                                                          for p in corners)
    data = scene.camera.data
    data.clip_start, data.clip_end = max(data.clip_start, 1e-4 * reach), reach  # its depths have 24 bits
    add_irradiance_grid(boxes, 2 if many else 4, add_lamps(description, things))
    bpy.ops.scene.light_cache_bake()


def set_up_cycles(scene, settings):
    cycles = scene.cycles
    scene.render.engine = "CYCLES"
    cycles.device = "CPU"
    cycles.pixel_filter_type = "BOX"
    # This pattern is as efficient as the default but scrambled per pixel, so that pixels are independent, as the bias
    # check requires. Since 4.2 it is a developer option, and the default is blue noise.
    preferences = bpy.context.preferences
    set_where_known(True, "show_developer_ui", preferences.view)
    set_where_known(True, "use_cycles_debug", preferences.experimental)
    first_known(cycles, "sampling_pattern", "SOBOL", "SOBOL_BURLEY")
    bounces = settings["depth"] - 1  # Cycles counts scattering events after the first
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = bounces
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.light_sampling_threshold = 0.0
    cycles.blur_glossy = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.use_denoising = cycles.use_fast_gi = cycles.use_auto_tile = False


def set_up_render(scene, settings):
    render = scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = settings["width"], settings["height"], 100
    render.threads_mode, render.threads = "FIXED", settings["threads"]
    render.use_persistent_data = True  # the BVH is built once, as in Duet
    render.use_compositing = render.use_sequencer = render.use_motion_blur = False
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.image_settings.color_mode = "RGB"
    render.dither_intensity = 0.0


def render(scene, spp, seed, adaptive, path):
    scene.render.filepath = path  # marks the scene as changed, which the settings of Cycles do not
    if not EEVEE:
        scene.cycles.samples, scene.cycles.seed, scene.cycles.use_adaptive_sampling = spp, seed, adaptive
        bpy.ops.render.render(write_still=True)
        return
    scene.eevee.taa_render_samples = spp
    start = time.perf_counter()
    bpy.ops.render.render()
    print(f"Render time (without synchronization): {time.perf_counter() - start}", flush=True)
    bpy.data.images["Render Result"].save_render(path)


def serve(scene):
    if EEVEE:
        bpy.ops.render.render()  # compiles the shaders
    print("duet: ready", flush=True)
    for line in sys.stdin:
        spp, seed, adaptive, path = line.rstrip("\n").split(" ", 3)
        render(scene, int(spp), int(seed), adaptive == "1", path)
        print("duet: rendered", flush=True)


def main():
    print(f"duet: Blender {bpy.app.version_string}", flush=True)
    with open(os.path.join(FOLDER, "scene.json")) as file:
        description = json.load(file)
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    things = make_objects(description, [make_material(m) for m in description["materials"]])
    for number, light in enumerate(description["lights"]):
        make_light(light, number)
    make_environment(description["environment"])
    make_camera(description["camera"])
    scene = bpy.context.scene
    set_up_render(scene, description["render"])
    if EEVEE:
        set_up_eevee(scene, description, things)
    else:
        set_up_cycles(scene, description["render"])
    serve(scene)


main()
