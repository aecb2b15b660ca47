// What stb leaves unchecked in PNG and JPEG files: it takes a file that ends early for one that goes on with zeros,
// ignores PNG's checksums, takes memory for any size that a header claims, and writes beyond its tables for some
// Huffman codes.
#pragma once

#include "common/image/formats.h"

namespace duet {

/// Throws Error unless a PNG's chunks are whole, from the header to the last, and hold enough for the size it claims.
void check_png(const ImageBytes& file);
/// Throws Error unless a JPEG's segments are whole, with a frame and an end, its Huffman tables sound, and its size is
/// one that the file can hold.
void check_jpeg(const ImageBytes& file);

} // namespace duet
