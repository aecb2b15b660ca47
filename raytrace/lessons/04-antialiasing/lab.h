// Lab 04: many samples per pixel.
#pragma once

#include "common/image/image.h"
#include "tests/grading/lab.h"

#include <cstdint>
#include <vector>

namespace duet::lab {

/// A disk of one color. Lengths are pixels, from the upper left corner of the picture; y points down.
struct Disk {
    Vec2 center;
    float radius = 1;
    Rgb color;
};

/// Given: the light at a point of a picture of disks on black. Later disks cover earlier ones.
inline Rgb light_at(const std::vector<Disk>& disks, Vec2 p) {
    Rgb light;
    for (const Disk& disk : disks)
        if (dot(p - disk.center, p - disk.center) < disk.radius * disk.radius) light = disk.color;
    return light;
}

/// Given: a random number in [0, 1). The state is changed, so the next call gives another. Any start value will do: it
/// is the seed (SplitMix64, Steele et al. 2014).
inline float random_number(std::uint64_t& state) {
    std::uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<float>((z ^ (z >> 31)) >> 40) * 0x1p-24f;
}

/// The mean light of samples. Light may be above 1, and nothing limits it here. Of no samples: black.
Rgb mean_light(const std::vector<Rgb>& samples);

/// Where in its pixel the sample i of n·n lies, 0 <= i < n·n: (0, 0) is the pixel's upper left corner, and (1, 1) its
/// lower right one. The pixel has n columns and n rows of cells. Sample i lies in column i % n, and in row i / n. `u`
/// says where in its cell: (0, 0) is the upper left corner of the cell, and (1, 1) its lower right one.
Vec2 sample_in_cell(int i, int n, Vec2 u);

/// The picture: each pixel is the mean light of n·n samples, one in each cell, at random within the cell. The numbers
/// are those of random_number, others in each pixel. The same seed gives the same picture, another seed another.
ImageRgb draw(const std::vector<Disk>& disks, int width, int height, int n, std::uint64_t seed);

/// The root of the mean squared difference of all components of two images of equal size, at least one pixel.
double rms_error(const ImageRgb& a, const ImageRgb& b);

/// How many random samples the error `wanted` takes, if `samples` of them have the error `error`: the least whole
/// number for which error / √N says so, and at least 1. All are above 0.
int samples_needed(int samples, double error, double wanted);

} // namespace duet::lab

DUET_LAB(mean_light, sample_in_cell, draw, rms_error, samples_needed)
