#include "common/image/stored_image.h"

#include "common/system/error.h"

namespace duet {

namespace {

bool sides_fit(long long width, long long height) {
    return width >= 1 && height >= 1 && width <= kMaxImageSide && height <= kMaxImageSide;
}

} // namespace

void check_image_size(const std::string& name, long long width, long long height) {
    if (sides_fit(width, height) && width * height <= kMaxImagePixels) return;
    throw Error(message(name, ": an image of ", width, " x ", height, " pixels, expected 1 to ", kMaxImageSide,
                        " a side and at most ", kMaxImagePixels, " in all"));
}

void check_written_size(const std::string& name, int width, int height) {
    if (!sides_fit(width, height))
        throw Error(
            message(name, ": an image of ", width, " x ", height, " pixels, expected 1 to ", kMaxImageSide, " a side"),
            1);
}

void check_pixel_data_size(const ImageBytes& file, long long width, long long height, double needed, double available) {
    if (needed <= available) return;
    throw Error(message(file.name, ": truncated: ", width, " x ", height, " pixels cannot be in its ",
                        file.bytes.size(), " bytes"));
}

} // namespace duet
