"""Small pictures with known values, written as files, and what a page must make of the values: computed here anew."""

import math
import struct
import zlib


def write_pfm(path, rows):
    """rows[y][x] = (r, g, b), the top row first (the file has the bottom one first)."""
    with open(path, "wb") as file:
        file.write(b"PF\n%d %d\n-1.0\n" % (len(rows[0]), len(rows)))
        for row in reversed(rows):
            for pixel in row:
                file.write(struct.pack("<3f", *pixel))


def write_png(path, rows):
    """rows[y][x] = (r, g, b) as bytes."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    lines = b"".join(b"\0" + bytes(v for pixel in row for v in pixel) for row in rows)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n"
                   + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0))
                   + chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b""))


def single(value):
    """The nearest number of single precision."""
    return struct.unpack("<f", struct.pack("<f", value))[0]


def half(value):
    """The nearest number of half precision: what the page keeps."""
    return struct.unpack("<e", struct.pack("<e", value))[0]


def srgb_byte(value):
    """The sRGB curve, IEC 61966-2-1."""
    v = min(max(value, 0), 1)
    return math.floor(255 * (12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055) + 0.5)


def luminance(rgb):
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]


def lightness(rgb):
    """CIE L* of sRGB bytes, 0 to 100."""
    y = luminance([v / 255 / 12.92 if v <= 10 else ((v / 255 + 0.055) / 1.055) ** 2.4 for v in rgb])
    return 116 * y ** (1 / 3) - 16 if y > 216 / 24389 else y * 24389 / 27


def number(text):
    """A number as the page writes it: with a real minus, perhaps a plus, perhaps a power of ten."""
    text = text.replace("\u2212", "-").replace("\u2009", "").replace("\u00a0", "")
    if "10" in text and any(c in text for c in "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"):
        factor, _, power = text.rpartition("10")
        power = int(power.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")))
        return float(factor.rstrip("·") or 1) * 10 ** power
    return float(text)
