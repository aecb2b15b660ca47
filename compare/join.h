// This file declares `compare join`, which joins several images in one image.
#pragma once

#include "common/program/view_transform_options.h"

#include <filesystem>
#include <vector>

namespace duet::compare {

/// JoinOptions are the arguments of join_images().
struct JoinOptions {
    std::vector<std::filesystem::path> images;
    std::filesystem::path output;
    int columns = 0; ///< of the grid; 0: all images in one row
    int gap = 0; ///< white pixels between images
    bool bands = false; ///< shows a band of each image in one image of their size, in place of a grid
    double slant_degrees = 0; ///< angle between the vertical and the lines between bands, which rise to the right
    ViewTransformOptions view_transform;
};

/// Returns a grid of images of one size, row by row. Cells that remain in the last row are white.
ImageRgb image_grid(const std::vector<ImageRgb>& images, int columns, int gap);
/// Returns one image of equally wide bands, from left to right one of each image. The images must have the same size.
ImageRgb image_bands(const std::vector<ImageRgb>& images, double gap, double slant_degrees);

/// Reads the images and writes the result. Throws Error if a file cannot be used, or the images differ in size.
int join_images(const JoinOptions& options);

} // namespace duet::compare
