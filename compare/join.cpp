#include "compare/join.h"

#include "common/image/image_file.h"
#include "common/program/program.h"
#include "common/vec/vec.h"

#include <algorithm>
#include <cmath>

namespace duet::compare {

namespace {

constexpr Rgb kWhite(1);

std::vector<ImageRgb> read_images_of_one_size(const std::vector<std::filesystem::path>& paths) {
    std::vector<ImageRgb> images;
    for (const std::filesystem::path& path : paths) {
        images.push_back(read_image(path));
        const ImageRgb &first = images.front(), &last = images.back();
        if (last.width() != first.width() || last.height() != first.height())
            throw Error(message("the images differ in size: ", paths.front().string(), " has ", first.width(), "x",
                                first.height(), " pixels, ", path.string(), " ", last.width(), "x", last.height()));
    }
    return images;
}

} // namespace

ImageRgb image_grid(const std::vector<ImageRgb>& images, int columns, int gap) {
    const int width = images.front().width(), height = images.front().height();
    const int rows = (static_cast<int>(images.size()) + columns - 1) / columns;
    check_image_size("the joined image", (static_cast<long long>(width) + gap) * columns - gap,
                     (static_cast<long long>(height) + gap) * rows - gap);
    ImageRgb grid((width + gap) * columns - gap, (height + gap) * rows - gap, kWhite);
    for (int i = 0; i < static_cast<int>(images.size()); ++i) {
        const int left = (width + gap) * (i % columns), top = (height + gap) * (i / columns);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) grid(left + x, top + y) = images[static_cast<std::size_t>(i)](x, y);
    }
    return grid;
}

ImageRgb image_bands(const std::vector<ImageRgb>& images, double gap, double slant_degrees) {
    ImageRgb result = images.front();
    const double width = result.width(), height = result.height(), slant = radians(slant_degrees);
    for (std::size_t i = 1; i < images.size(); ++i) {
        const double middle = width * static_cast<double>(i) / static_cast<double>(images.size());
        for (int y = 0; y < result.height(); ++y) {
            const double line = middle + (height / 2 - (y + 0.5)) * std::tan(slant);
            for (int x = 0; x < result.width(); ++x) {
                // The edge is antialiased: the fraction of a pixel beyond the line grows linearly over one pixel.
                const double beyond = (x + 0.5 - line) * std::cos(slant);
                const auto fraction = static_cast<float>(std::clamp(beyond + 0.5, 0.0, 1.0));
                const auto white = static_cast<float>(std::clamp(gap / 2 - std::abs(beyond) + 0.5, 0.0, 1.0));
                if (fraction > 0) result(x, y) = lerp(result(x, y), images[i](x, y), fraction);
                if (gap > 0 && white > 0) result(x, y) = lerp(result(x, y), kWhite, white);
            }
        }
    }
    return result;
}

int join_images(const JoinOptions& options) {
    check_writable_image(options.output);
    const std::vector<ImageRgb> images = read_images_of_one_size(options.images);
    const int columns = options.columns > 0 ? options.columns : static_cast<int>(images.size());
    const ImageRgb joined = options.bands ? image_bands(images, options.gap, options.slant_degrees)
                                          : image_grid(images, columns, options.gap);
    write_image(options.output, joined, {.view = options.view_transform.applied_to({})});
    return kExitOk;
}

} // namespace duet::compare
