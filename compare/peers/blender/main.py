# Builds the scene that compare/peers/export_scene.cpp wrote in Blender, then renders it on each request with Cycles,
# Blender's path tracer, or with EEVEE, its rasterizer.
# Run by compare/peers/blender.cpp: blender -b --factory-startup --debug-cycles --python main.py -- FOLDER ENGINE
# The scene's coordinates are used in Blender without rotation, with y up.
# The scripts support Blender 3.x and 4.x, and EEVEE up to 4.0.
import json
import math
import os
import sys
import time

import bpy
from mathutils import Matrix

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from eevee import set_up_eevee
from exported import EEVEE, FOLDER
from lights import make_environment, make_light
from materials import make_material
from meshes import make_objects
from nodes import first_known, set_where_known
from volumes import make_media


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


def set_up_cycles(scene, settings):
    cycles = scene.cycles
    scene.render.engine = "CYCLES"
    cycles.device = "CPU"
    cycles.pixel_filter_type = "BOX"
    # This pattern is as efficient as the default but scrambled per pixel, so that pixels are independent, as the bias
    # check requires. Since Blender 4.2 it is a developer option, and the default is blue noise.
    preferences = bpy.context.preferences
    set_where_known(True, "show_developer_ui", preferences.view)
    set_where_known(True, "use_cycles_debug", preferences.experimental)
    first_known(cycles, "sampling_pattern", "SOBOL", "SOBOL_BURLEY")
    bounces = settings["depth"] - 1  # Cycles counts scattering events after the first
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = bounces
    cycles.transmission_bounces = cycles.volume_bounces = bounces
    cycles.transparent_max_bounces = 1024  # the sides of a medium's box count as transparent surfaces
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
    make_media(description["media"], make_environment(description["environment"]))
    make_camera(description["camera"])
    scene = bpy.context.scene
    set_up_render(scene, description["render"])
    if EEVEE:
        set_up_eevee(scene, description, things)
    else:
        set_up_cycles(scene, description["render"])
    serve(scene)


main()
