// Defines planes, the images of one number per pixel that deferred shading reads and writes in SIMD batches.
#pragma once

#include "common/image/image.h"
#include "common/image/rgb.h"
#include "common/system/parallel.h"
#include "raster/geometry/packet.h"

#include <algorithm>

namespace duet::raster {

/// Stores one number per pixel. Rows are padded to whole cache lines, so a batch that starts at a multiple of
/// Floats::size may be loaded and stored aligned, past the right edge of the image too.
template <typename T> class Plane {
public:
    Plane() = default;
    Plane(int width, int height, T fill = T{})
        : width_(width), height_(height), stride_((width + kPadding - 1) / kPadding * kPadding),
          values_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height), fill) {}

    int width() const { return width_; }
    int height() const { return height_; }
    /// Returns the number of values from one row to the next.
    int stride() const { return stride_; }
    bool empty() const { return values_.empty(); }
    std::size_t memory_bytes() const { return values_.size() * sizeof(T); }
    void fill(T value) { std::fill(values_.begin(), values_.end(), value); }

    T* row(int y) { return values_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(stride_); }
    const T* row(int y) const {
        return values_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(stride_);
    }
    T& operator()(int x, int y) { return row(y)[x]; }
    const T& operator()(int x, int y) const { return row(y)[x]; }

private:
    static constexpr int kPadding = 16; ///< values; a cache line of floats, and the widest batch
    int width_ = 0, height_ = 0, stride_ = 0;
    std::vector<T, HugePageAllocator<T>> values_;
};

using PlaneFloat = Plane<float>;
using PlaneInt = Plane<std::int32_t>;

/// Loads the batch of pixels that starts at column x, a multiple of Floats::size, of row y.
template <typename T> xsimd::batch<T> load(const Plane<T>& plane, int x, int y) {
    return xsimd::batch<T>::load_aligned(plane.row(y) + x);
}
/// Stores a batch of values at the position from which load() reads it.
template <typename T> void store(Plane<T>& plane, int x, int y, const xsimd::batch<T>& values) {
    values.store_aligned(plane.row(y) + x);
}

/// Stores three numbers per pixel: a vector or a color.
struct Planes3 {
    PlaneFloat x, y, z;

    Planes3() = default;
    Planes3(int width, int height) : x(width, height), y(width, height), z(width, height) {}
    /// Sets the size. The contents are undefined; images of that size already keep their memory.
    void set_size(int width, int height) {
        if (x.width() != width || x.height() != height) *this = Planes3(width, height);
    }
    void fill(float value) { x.fill(value), y.fill(value), z.fill(value); }
    bool empty() const { return x.empty(); }
    std::size_t memory_bytes() const { return 3 * x.memory_bytes(); }

    Vec3T<Floats> vector(int column, int row) const {
        return {load(x, column, row), load(y, column, row), load(z, column, row)};
    }
    RgbT<Floats> color(int column, int row) const {
        return {load(x, column, row), load(y, column, row), load(z, column, row)};
    }
    void set(int column, int row, const Vec3T<Floats>& v) {
        store(x, column, row, v.x), store(y, column, row, v.y), store(z, column, row, v.z);
    }
    void set(int column, int row, const RgbT<Floats>& c) {
        store(x, column, row, c.r), store(y, column, row, c.g), store(z, column, row, c.b);
    }
    // The following functions access single pixels.
    Vec3 vector_at(int column, int row) const { return {x(column, row), y(column, row), z(column, row)}; }
    Rgb color_at(int column, int row) const { return {x(column, row), y(column, row), z(column, row)}; }
    void set_at(int column, int row, Vec3 v) { x(column, row) = v.x, y(column, row) = v.y, z(column, row) = v.z; }
    void set_at(int column, int row, Rgb c) { x(column, row) = c.r, y(column, row) = c.g, z(column, row) = c.b; }
};

/// Calls visit(x, y) for the first pixel of each batch of an image, in parallel over bands of kBandRows rows. The
/// bands keep threads off each other's cache lines, and let a stage reuse a band's rows while they are cached.
template <typename Visit> void for_each_batch(int width, int height, int threads, const Visit& visit) {
    constexpr int kBandRows = 8;
    parallel_for(static_cast<std::size_t>((height + kBandRows - 1) / kBandRows), threads, [&](std::size_t band) {
        const int first = static_cast<int>(band) * kBandRows;
        for (int y = first; y < std::min(first + kBandRows, height); ++y)
            for (int x = 0; x < width; x += static_cast<int>(Floats::size)) visit(x, y);
    });
}

} // namespace duet::raster
