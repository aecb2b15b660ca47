// These functions check what stb does not check in PNG and JPEG files. stb reads a truncated file as if zeros followed,
// ignores the checksums of PNG, allocates memory for any size that a header claims, and for some Huffman codes writes
// beyond the end of its tables.
#pragma once

#include "common/image/formats.h"

namespace duet {

/// Throws an Error unless all chunks of a PNG are complete, from the header to the end chunk, and their compressed data
/// can hold the image size in the header.
void check_png(const ImageBytes& file);
/// Throws an Error unless all segments of a JPEG are complete, with a frame and an end marker, its Huffman tables are
/// valid, and the file can hold the image size in the frame header.
void check_jpeg(const ImageBytes& file);

} // namespace duet
