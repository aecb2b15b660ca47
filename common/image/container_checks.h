// These functions check what the libraries that decode images do not check. stb reads a truncated PNG or JPEG as if
// zeros followed, ignores the checksums of PNG, allocates memory for any size that a header claims, and for some
// Huffman codes writes beyond the end of its tables. OpenEXR allocates memory for any size that an attribute claims.
#pragma once

#include "common/image/formats.h"

namespace duet {

/// Throws an Error unless all chunks of a PNG are complete, from the header to the end chunk, and their compressed data
/// can hold the image size in the header.
void check_png(const ImageBytes& file);
/// Throws an Error unless all segments of a JPEG are complete, with a frame and an end marker, its Huffman tables are
/// valid, and the file can hold the image size in the frame header.
void check_jpeg(const ImageBytes& file);
/// Throws an Error unless each attribute in the header of an EXR file of one part has the size that its type demands,
/// and lies in the file. (exr_header.cpp)
void check_exr_header(const ImageBytes& file);

} // namespace duet
