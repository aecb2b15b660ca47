"""Defines the figure of memory. It writes the large scenes that it needs."""
import json

from catalog import figure, number, table

SIDE = 2237  # vertices along a side of the height field, which has ten million triangles
INSTANCES = 100_000
LIGHTS = 10_000
IMAGE = 8_192  # pixels along a side of the large image
SIZE = "640x360"

CAMERA = {"eye": [0, 30, 60], "look_at": [0, 0, 0], "fov_degrees": 60}
FLOOR = {"type": "quad", "corner": [-50, 0, 50], "u": [100, 0, 0], "v": [0, 0, -100], "material": "white"}
SUN = {"type": "sun", "direction": [-0.3, -1, -0.2], "irradiance": 3}


def write_scene(run, name, objects, lights):
    """Writes a scene of these objects and lights, and returns its path."""
    path = f"out/figures/memory-{name}.json"
    content = {"camera": CAMERA, "materials": {"white": {"type": "diffuse", "albedo": [0.7, 0.7, 0.7]}},
               "objects": objects, "lights": lights}
    (run.source / path).write_text(json.dumps(content), encoding="utf-8")
    return path


def write_height_field(path):
    """Writes an OBJ file of a square of hills."""
    with open(path, "w", encoding="ascii") as file:
        for y in range(SIDE):
            file.writelines(f"v {40 * x / SIDE - 20:.4f} {(x * x + y * y) % 97 / 50:.3f} {20 - 40 * y / SIDE:.4f}\n"
                            for x in range(SIDE))
        for y in range(1, SIDE):
            for x in range(1, SIDE):
                a = (y - 1) * SIDE + x
                file.write(f"f {a} {a + 1} {a + SIDE + 1}\nf {a} {a + SIDE + 1} {a + SIDE}\n")


def triangles(run):
    field = run.source / "out" / "figures" / "memory-field.obj"
    if not field.exists():
        write_height_field(field)
    return write_scene(run, "triangles", [{"type": "mesh", "file": field.name, "material": "white"}], [SUN])


def instances(run):
    pear = {"type": "group", "name": "pear", "hidden": True,
            "objects": [{"type": "mesh", "file": "../../models/meshes/pear.obj"}]}
    shown = [{"type": "instance", "of": "pear", "transform": [{"translate": [i % 400 / 4 - 50, 0, i // 400 / 3 - 40]}]}
             for i in range(INSTANCES)]
    return write_scene(run, "instances", [pear, *shown], [SUN])


def lights(run):
    lamps = [{"type": "point", "position": [i % 100 - 50, 1, i // 100 - 50], "intensity": [0.1, 0.1, 0.1]}
             for i in range(LIGHTS)]
    return write_scene(run, "lights", [FLOOR], lamps)


def peak(run, program, path, size):
    return run(program, path, "--size", size, "--spp", 1, "--quiet", output=".ppm").data["peak_memory_bytes"]


@figure("memory", 12)
def memory(run):
    """the most memory that both programs take for large scenes and a large image"""
    small = write_scene(run, "floor", [FLOOR], [SUN])
    rows, least = [], {}
    for what, count, path, size in (("a floor and a sun", 0, small, SIZE),
                                    ("triangles of one mesh", 2 * (SIDE - 1) ** 2, triangles(run), SIZE),
                                    ("instances of one mesh", INSTANCES, instances(run), SIZE),
                                    ("point lights", LIGHTS, lights(run), SIZE),
                                    (f"pixels, {IMAGE:,} a side", IMAGE ** 2, small, f"{IMAGE}x{IMAGE}")):
        cells = []
        for program in ("raster", "raytrace"):
            bytes_ = peak(run, program, path, size)
            least.setdefault(program, bytes_)  # of the first row
            cells += [number(bytes_ / 1e6, 3), number((bytes_ - least[program]) / count, 3) if count else ""]
        rows.append([what, f"{count:,}" if count else "", *cells])
    return table(["", "number", "rasterizer, MB", "bytes each", "path tracer, MB", "bytes each"], rows)
