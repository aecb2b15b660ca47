// Stage 10: what is drawn over a finished picture: lines, and ink at edges.
#pragma once

#include "raster/overlay/edges.h"
#include "raster/prepare.h"

namespace duet::raster {

/// Whether these settings ink edges.
bool draws_edges(const Settings& settings);

/// Of each pass, how much of each pixel is covered. Refers to what it is made of.
class Overlay {
public:
    Overlay(const PreparedData& data, const Settings& settings, const View& view)
        : data_(data), settings_(settings), sums_(view.width, view.height, 0.0f) {}

    void add_lines(const PassView& view);
    void add_edges(const SeenPicture& seen);
    /// White lines on black; ink on paper; or ink on the picture.
    void put(ImageRgb& picture) const;

private:
    const PreparedData& data_;
    const Settings& settings_;
    ImageFloat sums_;
    int samples_ = 0;
};

} // namespace duet::raster
