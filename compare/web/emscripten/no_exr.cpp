// The page has no OpenEXR, so these functions of common/image/formats.h and image_file.h throw an Error that says so.
#include "common/image/formats.h"
#include "common/image/image_file.h"
#include "common/system/error.h"

namespace duet {

namespace {

[[noreturn]] void refuse(const std::string& name) {
    throw Error(message(name, ": the web page reads and writes no EXR files. Convert them to .hdr or .pfm"));
}

} // namespace

StoredImage decode_exr(const ImageBytes& file) { refuse(file.name); }
ExrFile read_exr(const std::filesystem::path& path) { refuse(path.string()); }
ExrFile decode_exr_channels(const ImageBytes& file) { refuse(file.name); }
void write_exr(const std::filesystem::path& path, int, int, const std::vector<ExrChannel>&,
               const std::vector<ExrAttribute>&) {
    refuse(path.string());
}

} // namespace duet
