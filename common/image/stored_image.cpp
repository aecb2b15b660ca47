#include "common/image/stored_image.h"

#include "common/system/error.h"

namespace duet {

void check_image_size(const std::string& name, long long width, long long height, int exit_code) {
    const bool sides_fit = width >= 1 && height >= 1 && width <= kMaxImageSide && height <= kMaxImageSide;
    if (sides_fit && width * height <= kMaxImagePixels) return;
    throw Error(message(name, ": an image of ", width, " x ", height, " pixels, expected 1 to ", kMaxImageSide,
                        " a side and at most ", kMaxImagePixels, " in all"),
                exit_code);
}

void check_pixel_data_size(const ImageBytes& file, long long width, long long height, double needed, double available) {
    if (needed <= available) return;
    throw Error(message(file.name, ": truncated: ", width, " x ", height, " pixels cannot be in its ",
                        file.bytes.size(), " bytes"));
}

} // namespace duet
