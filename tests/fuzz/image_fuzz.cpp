// This fuzz target decodes any bytes as an image. Each reader must return pixels or throw Error, nothing else.
#include "common/image/formats.h"
#include "common/image/image_file.h"
#include "tests/fuzz/require.h"
#include "tests/support/errors.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const duet::ImageBytes file{"fuzz", {reinterpret_cast<const char*>(data), size}};
    duet::test::error_of([&] {
        // A file without a signature is decoded as a TGA.
        const duet::StoredImage image = duet::decode_image(file, ".tga");
        const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
        duet::require(image.width >= 1 && image.height >= 1 && image.channels >= 1 && image.channels <= 4);
        duet::require(image.values.size() == pixels * static_cast<std::size_t>(image.channels));
    });
    if (file.bytes.starts_with("\x76\x2f\x31\x01"))
        duet::test::error_of([&] { duet::decode_exr_channels(file); });
    return 0;
}
