"""Defines the figures of raster/measurements.md."""
from statistics import median

import draw
from catalog import figure, ms, number, scene, stem, table
from measure import Failed

LIT_SCENES = ("cornell", "veach", "everything", "demo", "spheres", "hall", "glass")
MESHES = ("models/meshes/amphora.obj", "models/generated/octopus.obj", "models/generated/octopus-million.obj")


WORKS = {"phong": "Phong", "depth": "depth"}


def lit_frames(run):
    return run("compare", "frames", *map(scene, LIT_SCENES), "--repeats", 9).data


@figure("lit-frames", 2)
def lit_frames_table(run):
    """whole frames of `lit`, and their preparation"""
    rows = []
    for result in lit_frames(run)["lit"]:
        one, every = result["rows"][0], result["rows"][-1]
        rows.append([f"`{result['scene']}`", ms(every["frame_seconds"]), ms(one["frame_seconds"]),
                     number(one["frame_seconds"] / every["frame_seconds"]), ms(result["prepare_seconds"])])
    return table(["scene", "ms, all cores", "one core", "scaling", "prepare, ms"], rows)


# The bytes that a stage reads and writes per pixel: four for each plane, and a quarter of that at half resolution.
# Surface attributes write 17 planes. Direct light reads 12 of them and writes 9, which the shadow denoiser reads.
STAGE_BYTES = {"ambient occlusion": 58, "direct light and shadows": 84, "indirect light": 78, "other": 16,
               "reflections": 56, "shadow denoiser": 60, "surface attributes": 68}
# What else a stage reads per pixel, from places that lie apart.
STAGE_GATHERS = {"ambient occlusion": "5 depths, up to 45 of occluders",
                 "direct light and shadows": "4 to 12 texels per area light, 16 per sun",
                 "indirect light": "22 to 44 of half resolution, 40 of probes",
                 "reflections": "16 to 40 of a probe",
                 "surface attributes": "4 to 128 texels per texture"}


@figure("lit-stages", 2)
def lit_stages(run):
    """the stages of `lit` (the frames of lit-frames), and the least time of each by memory"""
    measured = lit_frames(run)
    frames = {result["scene"]: result["rows"][-1]["stages"] for result in measured["lit"]}
    scenes = ("cornell", "veach", "demo", "spheres", "glass")
    least = 5e-4  # seconds: stages that take less in every scene are left out
    stages = sorted({stage for name in scenes for stage, seconds in frames[name].items() if seconds > least})
    bandwidth = measured["copy_bytes_per_second"]
    floor = lambda stage: ms(1920 * 1080 * STAGE_BYTES[stage] / bandwidth, 2) if stage in STAGE_BYTES else ""
    heads = ["stage, ms", *(f"`{name}`" for name in scenes), "floor", "bytes a pixel", "gathers a pixel"]
    lines = [[stage, *(ms(frames[name].get(stage, 0), 2) for name in scenes), floor(stage),
              STAGE_BYTES.get(stage, ""), STAGE_GATHERS.get(stage, "")] for stage in stages]
    return f"{table(heads, lines)}\n\nFloors are by a copy of memory: {number(bandwidth / 1e9)} GB/s on all cores."


def duration(seconds):
    return f"{number(seconds)} s" if seconds >= 1 else f"{ms(seconds, 2)} ms"


def phong_frames(run):
    run.generate("octopus-million")
    rows = run("compare", "frames", *MESHES, "--repeats", 9).data["rows"]
    if not rows[0]["peer"]:
        raise Failed("the programs were built without llvmpipe (compare/README.md, Peers)")
    return rows


@figure("llvmpipe", 2)
def llvmpipe(run):
    """frames of meshes beside Mesa's llvmpipe, with a plot"""
    rows, pairs, rates = [], [], {}
    for row in phong_frames(run):
        rates.setdefault((row["mesh"], row["triangles"], row["view"], row["work"]), []).append(row)
    for (mesh, triangles, view, work), measured in rates.items():
        one, every = measured[0], measured[-1]  # rows of one thread and of all threads
        rows.append([f"`{mesh}`, {triangles:,}", view, WORKS[work]] + [ms(1 / each["ours"]) for each in (one, every)]
                    + [f"{number(each['ratio']['median'])} ({number(each['ratio']['min'])} to "
                       f"{number(each['ratio']['max'])})" for each in (one, every)])
        if view == "whole":
            pairs.append((f"{mesh}, {WORKS[work]}", (1 / every["ours"], 1 / every["peer"])))
    peer = next(iter(rates.values()))[0]["peer_name"]
    plot = draw.pairs("A frame at 1920 × 1080", ("Duet's rasterizer", "Mesa's llvmpipe"), duration, pairs)
    return (table(["mesh, triangles", "view", "work", "ms, one core", "all cores",
                   "llvmpipe's time over ours, one core", "all cores"], rows)
            + f"\n\nPeer: {peer}. Medians, and in brackets the least and the largest of all repeats.\n\n"
            "![Milliseconds per frame of three meshes by llvmpipe and, to the left of it, by Duet]"
            "(gallery/llvmpipe.svg)", {"gallery/llvmpipe.svg": plot})


@figure("tinyrenderer", 1)
def tinyrenderer(run):
    """a textured frame; that of tinyrenderer is quoted"""
    frame = ("compare", "frames", MESHES[0], "--size", "1024x1024", "--threads", 1, "--view", "whole", "--work",
             "phong", "--no-peer", "--repeats", 21)
    plain = run(*frame).data["rows"][0]
    textured = run(*frame, "--texture", "models/textures/amphora.png").data["rows"][0]
    return table(["one thread, 1024 × 1024", "ms per frame"], [
        ["Duet, Phong's model, one color", ms(1 / plain["ours"])],
        ["Duet, the same with a texture, filtered anisotropically", ms(1 / textured["ours"])],
        ["tinyrenderer, its own textured shader, 5,022 triangles with a floor (quoted: github.com/ssloy/tinyrenderer, "
         "g++ 12 with `-O3 -march=native`, 2026-11-21, on a processor 1.3 times as fast)", "80.5"]])


@figure("multisampling", 2)
def multisampling(run):
    """--msaa beside shading each of the same samples"""
    rows = []
    for samples in (4, 8, 16):
        ratios = []
        for shading in ("phong", "toon"):
            command = ("raster", scene("demo"), "--size", "640x360", "--shading", shading, "--quiet", "--msaa", samples)
            seconds = {way: [] for way in ((), ("--sample-shading",))}
            for seed in range(3):
                for way, found in seconds.items():
                    found.append(run(*command, *way, "--seed", seed, output=".png").data["seconds"]["render"])
            ratios.append(number(median(seconds["--sample-shading",]) / median(seconds[()])))
        rows.append([samples, *ratios])
    return table(["samples", "times as fast, `phong`", "`toon`"], rows)


def raster_bench(run):
    return run("compare", "bench", *map(scene, LIT_SCENES), "--techniques", "raster,path", "--samplers", "sobol",
               "--spp", "1,4,16", "--repeats", 3, output="")


@figure("raster-error", 4)
def raster_error(run):
    """error and time of both pipelines, and the path tracer's time to the same error"""
    rows = []
    for result in raster_bench(run).data["scenes"]:
        line = [f"`{stem(result['scene'])}`"]
        for row in result["rows"]:
            if row["technique"] == "raster" and row["spp"] < 16:
                line += [f"{ms(row['seconds']['value'], 2)}, {number(row['relmse']['value'])}", dominates(row)]
        rows.append(line)
    return table(["scene", "1 sample: ms, relMSE", "dominates", "4 samples: ms, relMSE", "dominates"], rows)


def dominates(row):
    """Returns the path tracer's time to the error of a row over the row's time, as words."""
    found = row["dominates"]
    return f"{'at most ' if found['at_most'] else ''}{number(found['ratio']['value'])}" if found else "–"


@figure("error-against-time", 4)
def error_plot(run):
    """the plot of the demo scene (the measurement of raster-error)"""
    plot = (run.source / raster_bench(run).output / "demo.svg").read_text(encoding="utf-8")
    return ("![Relative squared error over seconds of the demo scene: the rasterizer starts lower, the path tracer "
            "goes on falling](gallery/error-against-time.svg)", {"gallery/error-against-time.svg": plot})


@figure("equal-error", 4)
def equal_error(run):
    """the time of both pipelines to the same error (the measurement of raster-error)"""
    pairs = []
    for result in raster_bench(run).data["scenes"]:
        row = next(row for row in result["rows"] if row["technique"] == "raster" and row["spp"] == 1)
        if row["dominates"] and not row["dominates"]["at_most"]:
            ours = row["seconds"]["value"]
            pairs.append((stem(result["scene"]), (ours, ours * row["dominates"]["ratio"]["value"])))
    plot = draw.pairs("Time to the error of one rasterized sample", ("rasterizer", "path tracer"), duration, pairs)
    return ("![In each scene the rasterizer's milliseconds at one sample, and those of the path tracer to the same "
            "error](gallery/equal-error.svg)", {"gallery/equal-error.svg": plot})


@figure("eevee", 6)
def eevee(run):
    """the rasterizer beside Blender's"""
    rows = []
    for name in ("cornell", "glass", "open-sky", "spheres"):
        result = run("compare", "bench", scene(name), "--techniques", "raster", "--spp", 1, "--peer", "eevee",
                     "--reference-spp", 1024, output="").data["scenes"][0]
        theirs, ours = ({key: row[key]["value"] for key in ("seconds", "relmse")}
                        for technique in ("eevee", "raster") for row in result["rows"]
                        if row["technique"] == technique)
        rows.append([f"`{name}`"] + [f"{ms(each['seconds'], 2)}, {number(each['relmse'])}" for each in (theirs, ours)]
                    + [number(theirs["seconds"] / ours["seconds"]), number(theirs["relmse"] / ours["relmse"])])
    return table(["scene", "EEVEE: ms, relMSE", "rasterizer: ms, relMSE", "EEVEE's time over ours",
                  "its error over ours"], rows)


EFFECTS = ("--no-shadows", "--no-ambient-occlusion", "--no-indirect")


@figure("light-effects", 3)
def light_effects(run):
    """error and time of `lit` without each of its effects"""
    rows = []
    for name, size in (("cornell", "256x256"), ("everything", "320x240"), ("demo", "480x270"), ("spheres", "480x270")):
        reference = run("raytrace", scene(name), "--size", size, "--spp", 256, "--adaptive", "--quiet", output=".exr")
        line = [f"`{name}`"]
        for effect in (None, *EFFECTS):
            image = run("raster", scene(name), "--size", size, "--spp", 4, "--quiet", *([effect] if effect else []),
                        output=".exr")
            metrics = run("compare", "images", image.output, reference.output, "--quiet").data
            line.append(f"{number(metrics['relmse_trimmed'])}, {ms(image.data['seconds']['render'], 2)}")
        rows.append(line)
    return table(["scene: error, ms", "all effects"] + [f"`{effect}`" for effect in EFFECTS], rows)
