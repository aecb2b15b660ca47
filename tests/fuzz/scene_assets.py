"""The meshes, materials and images that the scenes of random_scenes.py use. They are the same for every seed."""
import math
import random
import struct
import zlib

MESHES = ["torus.obj", "sheet.obj", "soup.obj", "polygons.obj", "materials.obj"]
IMAGES = ["rgb.png", "rgba.png", "gray.png", "colors.ppm", "colors.tga", "linear.pfm", "sky.hdr"]
SMOKE, SMOKE_POINTS = "smoke.raw", [3, 5, 4]
ENVIRONMENTS = ["sky.hdr", "linear.pfm", "rgb.png"]

# One material for each row of the table of MTL files in models/README.md, and further ones for the maps.
MTL = """newmtl light\nKe 3 2 1\nKd 0.2 0.2 0.2\n
newmtl textured_light\nmap_Ke rgb.png\nmap_Kd rgb.png\n
newmtl glass\nillum 7\nNi 1.5\nTf 0.9 1 0.9\n
newmtl water\nillum 2\nd 0.3\nNi 1.33\n
newmtl mirror\nillum 3\nKs 0.9 0.8 0.7\nNs 200\nmap_Ks rgb.png\n
newmtl painted\nKd 0.7 0.1 0.1\nPm 0.5\nPr 0.3\nPc 0.5\nPcr 0.1\nNi 1.4\nmap_Pm gray.png\nmap_Pr gray.png\n
newmtl matte\nmap_Kd -s 2 3 1 rgb.png\nnorm rgb.png\nd 0.5\n
newmtl rough\nKd 0.5 0.5 0.5\nmap_Bump -bm 2 gray.png\nmap_d rgba.png\n"""


def png(width, height, channels, pixel):
    """A PNG file of 8 bits per channel. The function pixel(x, y) returns the values of one pixel from 0 to 255."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes(v for x in range(width) for v in pixel(x, y)[:channels]) for y in range(height))
    header = struct.pack(">IIBBBBB", width, height, 8, {1: 0, 3: 2, 4: 6}[channels], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def pixel_values(x, y):
    """Red, green, blue and alpha of the images, from 0 to 255: gradients with some structure."""
    return (x * 37 + y * 5) % 256, (x * x + y * 11) % 256, 128 + 16 * ((x + y) % 8), 255 * ((x // 2 + y // 2) % 2)


def images():
    """The image files, as a dictionary from name to bytes. None has the size of another."""
    ppm = bytes(v for y in range(4) for x in range(6) for v in pixel_values(x, y)[:3])
    tga = struct.pack("<BBBHHBHHHHBB", 0, 0, 2, 0, 0, 0, 0, 0, 5, 3, 24, 0)
    tga += bytes(v for y in range(3) for x in range(5) for v in pixel_values(x, y)[:3])
    pfm = b"".join(struct.pack("<f", v / 100) for y in range(5) for x in range(10) for v in pixel_values(x, y)[:3])
    # Pixels of a Radiance file: three mantissas and an exponent. One pixel is as bright as the sun.
    hdr = bytearray(v for y in range(8) for x in range(16) for v in (*(max(m, 3) for m in pixel_values(x, y)[:3]), 128))
    hdr[4 * 37:4 * 38] = bytes([255, 240, 200, 144])
    return {
        "rgb.png": png(16, 8, 3, pixel_values), "rgba.png": png(9, 7, 4, pixel_values),
        "gray.png": png(1, 13, 1, pixel_values), "colors.ppm": b"P6\n6 4\n255\n" + ppm, "colors.tga": tga,
        "linear.pfm": b"PF\n10 5\n-1.0\n" + pfm,
        SMOKE: bytes(i * 37 % 256 if i % 4 else 0 for i in range(3 * 5 * 4)),
        "sky.hdr": b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n" + bytes(hdr),
    }


def lines_of(keyword, vectors):
    return [keyword + "".join(f" {value:.6g}" for value in vector) for vector in vectors]


def torus():
    """A closed mesh of quads without normals or texture coordinates."""
    def point(i, j):
        a, b = math.tau * i / 14, math.tau * j / 8
        ring = 0.7 + 0.3 * math.cos(b)
        return ring * math.cos(a), 0.3 * math.sin(b), ring * math.sin(a)
    faces = [[8 * (i % 14) + j % 8 + 1 for i, j in ((i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j))]
             for i in range(14) for j in range(8)]
    return lines_of("v", (point(i, j) for i in range(14) for j in range(8))) + lines_of("f", faces)


def sheet(materials=()):
    """An open, wavy grid with texture coordinates and normals. Its faces have the materials in turn."""
    grid = [(i, j) for i in range(6) for j in range(6)]
    lines = lines_of("v", ((i / 2.5 - 1, 0.3 * math.sin(i + j), 1 - j / 2.5) for i, j in grid))
    lines += lines_of("vt", ((i / 5, j / 5) for i, j in grid))
    lines += lines_of("vn", ((-0.75 * math.cos(i + j), 1, 0.75 * math.cos(i + j)) for i, j in grid))
    for n, (i, j) in enumerate((i, j) for i in range(5) for j in range(5)):
        if materials:
            lines.append(f"usemtl {materials[n % len(materials)]}")
        corners = (6 * i + j + 1, 6 * i + j + 7, 6 * i + j + 8, 6 * i + j + 2)
        lines.append("f" + "".join(f" {c}/{c}/{c}" for c in corners))
    return lines


def soup():
    """Triangles anywhere: ordinary ones, slivers, triangles of zero area, faces that name a vertex twice, vertices with
    zero normals or without texture coordinates, and negative indices."""
    numbers = random.Random("soup")
    lines = ["vt 0 0", "vt 1 0", "vt 0 1", "vn 0 0 0", "vn 0 1 0"]
    for n in range(60):
        a, b, c = ([numbers.uniform(-1, 1) for _ in range(3)] for _ in range(3))
        if n % 6 == 1:  # A sliver.
            c = [p + 0.5 * (q - p) + 1e-6 * r for p, q, r in zip(a, b, c)]
        if n % 6 == 2:  # Zero area: the corners lie on a line, or two of them at one place.
            c = [2 * q - p for p, q in zip(a, b)] if n % 12 == 2 else b
        lines += lines_of("v", (a, b, c))
        lines.append(["f -3 -2 -1", "f -3/1/2 -2/2/2 -1/3/2", "f -3/1/1 -2/2/2 -1/3/1", "f -3/1 -2 -1/3",
                      "f -3 -2 -2", "f -3//2 -2//2 -1//2", "f -3 -2 -1"][n % 7])
    return lines


def polygons():
    """A convex pentagon, a concave quad, a concave star that bends, and a polygon that visits a vertex twice; lines,
    points and smoothing groups besides, which are ignored."""
    star = [((0.3 + 0.7 * (n % 2)) * math.cos(math.pi * n / 5), 0.1 * (n % 3),
             -(0.3 + 0.7 * (n % 2)) * math.sin(math.pi * n / 5)) for n in range(10)]
    pentagon = [(math.cos(math.tau * n / 5), math.sin(math.tau * n / 5), -1) for n in range(5)]
    lines = ["o polygons", "g a b", "s 1"] + lines_of("v", star + pentagon)
    lines += lines_of("v", [(-1, -1, 1), (1, -1, 1), (0, -0.5, 1), (0, 1, 1)])
    lines += ["usemtl undefined", "f 1 2 3 4 5 6 7 8 9 10", "s off", "f 11 12 13 14 15", "f 16 17 18 19",
              "f 16 17 17 19", "l 1 2 3", "p 4"]
    return lines


def write_assets(folder):
    """Writes the meshes, their materials and the images, except those that are there already."""
    names = [line.split()[1] for line in MTL.splitlines() if line.startswith("newmtl")]
    meshes = [torus(), sheet(), soup(), polygons(), ["mtllib materials.mtl"] + sheet(names)]
    files = {name: ("\n".join(lines) + "\n").encode() for name, lines in zip(MESHES, meshes)}
    for name, data in {**files, **images(), "materials.mtl": MTL.encode()}.items():
        path = folder / name
        if not path.exists() or path.read_bytes() != data:
            path.write_bytes(data)
