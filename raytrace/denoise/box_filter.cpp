#include "raytrace/denoise/box_filter.h"

#include "common/system/parallel.h"

namespace duet::raytrace {

Planes box_filter(Planes planes, int radius, int threads) {
    const int width = planes.width();
    planes.extend_to_border();
    Planes result(width, planes.height(), planes.count());
    const float side = static_cast<float>(2 * radius + 1);
    const PixelBatch scale(1 / (side * side));
    parallel_for(static_cast<std::size_t>(planes.height()), threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        // Columns are summed first, from the pixel at −radius on.
        std::vector<float> columns(static_cast<std::size_t>(width + 2 * radius + 2 * kBatchWidth));
        for (std::size_t plane = 0; plane < planes.count(); ++plane) {
            for (int x = 0; x < width + 2 * radius; x += kBatchWidth) {
                PixelBatch sum(0.0f);
                for (int j = -radius; j <= radius; ++j) sum += planes.load(plane, x - radius, y + j);
                sum.store_unaligned(&columns[static_cast<std::size_t>(x)]);
            }
            for (int x = 0; x < width; x += kBatchWidth) {
                PixelBatch sum(0.0f);
                for (int i = 0; i <= 2 * radius; ++i)
                    sum += PixelBatch::load_unaligned(&columns[static_cast<std::size_t>(x + i)]);
                result.store(plane, x, y, sum * scale);
            }
        }
    });
    return result;
}

} // namespace duet::raytrace
