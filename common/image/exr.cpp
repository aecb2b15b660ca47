// This file reads and writes EXR files with OpenEXR. OpenEXR allocates memory for any size that a header claims. The
// header is therefore read and checked first, and files are read from memory.
#include "common/image/container_checks.h"
#include "common/image/formats.h"
#include "common/system/file.h"
#include "common/system/parallel.h"

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <ImfVersion.h>

#include <algorithm>
#include <cstring>
#include <fstream>

namespace duet {

namespace fs = std::filesystem;

namespace {

class MemoryStream : public Imf::IStream {
public:
    explicit MemoryStream(const ImageBytes& file) : IStream(file.name.c_str()), bytes_(file.bytes) {}

    bool read(char data[], int size) override {
        const auto wanted = static_cast<std::size_t>(std::max(size, 0));
        if (wanted > bytes_.size() - at_) throw Iex::InputExc("the file ends early");
        std::memcpy(data, bytes_.data() + at_, wanted);
        at_ += wanted;
        return at_ < bytes_.size();
    }
    uint64_t tellg() override { return at_; }
    void seekg(uint64_t position) override {
        if (position > bytes_.size()) throw Iex::InputExc("the file ends early");
        at_ = static_cast<std::size_t>(position);
    }

private:
    std::string_view bytes_;
    std::size_t at_ = 0;
};

// Calls action() and converts the exceptions of OpenEXR to Errors, which begin with `problem`.
template <typename Action> auto convert_errors(const std::string& problem, int exit_code, const Action& action) {
    try {
        return action();
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        throw Error(message(problem, ": ", error.what()), exit_code);
    }
}
template <typename Read> auto convert_read_errors(const ImageBytes& file, const Read& read) {
    return convert_errors(file.name + ": not a readable EXR image", 2, read);
}

// Returns the number of threads with which OpenEXR processes an image of that many values. OpenEXR has its own thread
// pool, which is started for the first large image. 0 means that OpenEXR uses the calling thread.
int exr_threads(double values) {
#if defined(DUET_STD_THREADS)
    // ThreadSanitizer does not see the locks of a library that is not instrumented (see common/system/parallel.cpp).
    constexpr double kMinParallelValues = kInfinity;
#else
    constexpr double kMinParallelValues = 500'000;
#endif
    if (values < kMinParallelValues || available_threads() == 1) return 0;
    static const int threads = [] {
        Imf::setGlobalThreadCount(available_threads());
        return available_threads();
    }();
    return threads;
}

struct Window {
    Imath::Box2i box;
    long long width = 0, height = 0;
};

Window data_window(const Imf::Header& header) {
    const Imath::Box2i& box = header.dataWindow();
    return {box, 1LL + box.max.x - box.min.x, 1LL + box.max.y - box.min.y};
}

double bytes_per_pixel(const Imf::Header& header) {
    double bytes = 0;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
        bytes += channel.channel().type == Imf::HALF ? 2 : 4;
    return bytes;
}

// Returns an upper bound on the compression ratio. The ratio of deflate is at most 1032:1, and PXR24 first drops one
// byte of four. PIZ and RLE compress less. DWA can reduce 64 values to one before deflate.
double max_compression_ratio(Imf::Compression compression) {
    return compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION ? 132096 : 1376;
}

// Throws an Error for subsampled channels, for images or tiles that are too large, and for an image size that the file
// cannot contain.
void check_header(const ImageBytes& file, const Imf::Header& header) {
    const Window window = data_window(header);
    check_image_size(file.name, window.width, window.height);
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
        if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1)
            throw Error(
                message(file.name, ": channel ", channel.name(), " is subsampled, expected a value for each pixel"));
    constexpr double kMaxTileSide = 4096, kMaxRowsPerChunk = 256;
    const double pixel = bytes_per_pixel(header);
    const double bytes = pixel * static_cast<double>(window.width) * static_cast<double>(window.height);
    check_pixel_data_size(file, window.width, window.height, bytes / max_compression_ratio(header.compression()),
                          static_cast<double>(file.bytes.size()));
    double chunk_bytes = pixel * static_cast<double>(window.width) * kMaxRowsPerChunk;
    if (header.hasTileDescription()) {
        const Imf::TileDescription& tile = header.tileDescription();
        if (tile.xSize > kMaxTileSide || tile.ySize > kMaxTileSide)
            throw Error(message(file.name, ": tiles of ", tile.xSize, " x ", tile.ySize, " pixels, expected at most ",
                                kMaxTileSide, " a side"));
        chunk_bytes = std::max(chunk_bytes, pixel * tile.xSize * tile.ySize);
    }
    if (std::max(bytes, chunk_bytes) > kMaxExrBytes)
        throw Error(message(file.name, ": ", pixel, " bytes a pixel at ", window.width, " x ", window.height,
                            " pixels, expected at most 8 GiB in all"));
}

Imf::Header read_header(const ImageBytes& file) {
    MemoryStream stream(file);
    char start[8];
    stream.read(start, 8);
    int version = 0;
    for (int i = 7; i >= 4; --i) version = version << 8 | static_cast<unsigned char>(start[i]);
    if (Imf::isMultiPart(version)) throw Error(message(file.name, ": an EXR of several parts, expected a single one"));
    if (Imf::isNonImage(version)) throw Error(message(file.name, ": an EXR of deep pixels, expected flat ones"));
    check_exr_header(file);
    Imf::Header header;
    header.readFrom(stream, version);
    check_header(file, header);
    header.sanityCheck(Imf::isTiled(version));
    return header;
}

Imf::Slice slice(Imf::PixelType type, const void* values, const Imath::Box2i& window) {
    // A Slice takes a non-const pointer for reading and for writing files. OpenEXR does not modify the values when it
    // writes a file.
    return Imf::Slice::Make(type, const_cast<void*>(values), window);
}

void read_pixels(const ImageBytes& file, const Imf::FrameBuffer& frame, const Window& window) {
    MemoryStream stream(file);
    Imf::InputFile input(stream, exr_threads(static_cast<double>(window.width * window.height)));
    input.setFrameBuffer(frame);
    input.readPixels(window.box.min.y, window.box.max.y);
}

// Returns the names of the image channels that the file has: R, G and B, or Y, followed by A if present. Throws an
// Error if neither set exists.
std::vector<const char*> image_channels(const ImageBytes& file, const Imf::ChannelList& channels) {
    std::vector<const char*> names;
    const bool rgb = channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B");
    if (rgb)
        names = {"R", "G", "B"};
    else if (channels.findChannel("Y"))
        names = {"Y"};
    else {
        std::string found;
        for (auto channel = channels.begin(); channel != channels.end() && found.size() < 200; ++channel)
            found += message(' ', channel.name());
        throw Error(message(file.name, ": channels", found.empty() ? " none" : found, ", expected R, G and B, or Y"));
    }
    if (channels.findChannel("A")) names.push_back("A");
    return names;
}

} // namespace

StoredImage decode_exr(const ImageBytes& file) {
    return convert_read_errors(file, [&] {
        const Imf::Header header = read_header(file);
        const Window window = data_window(header);
        const std::vector<const char*> names = image_channels(file, header.channels());
        StoredImage image{static_cast<int>(window.width),
                          static_cast<int>(window.height),
                          static_cast<int>(names.size()),
                          StoredImage::Encoding::kLinear,
                          {}};
        const std::size_t stride = names.size() * sizeof(float);
        image.values.resize(static_cast<std::size_t>(window.width * window.height) * names.size());
        Imf::FrameBuffer frame;
        for (std::size_t c = 0; c < names.size(); ++c)
            frame.insert(names[c], Imf::Slice::Make(Imf::FLOAT, &image.values[c], window.box, stride,
                                                    stride * static_cast<std::size_t>(window.width)));
        read_pixels(file, frame, window);
        return image;
    });
}

ExrFile decode_exr_channels(const ImageBytes& file) {
    return convert_read_errors(file, [&] {
        const Imf::Header header = read_header(file);
        const Window window = data_window(header);
        ExrFile result{static_cast<int>(window.width), static_cast<int>(window.height), {}, {}};
        const auto count = static_cast<std::size_t>(window.width * window.height);
        Imf::FrameBuffer frame;
        for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
            ExrChannel& values = result.channels.emplace_back(ExrChannel{channel.name(), {}, {}});
            const bool integers = channel.channel().type == Imf::UINT;
            if (integers)
                values.integers.resize(count);
            else
                values.floats.resize(count);
            frame.insert(channel.name(), integers ? slice(Imf::UINT, values.integers.data(), window.box)
                                                  : slice(Imf::FLOAT, values.floats.data(), window.box));
        }
        read_pixels(file, frame, window);
        for (auto attribute = header.begin(); attribute != header.end(); ++attribute)
            if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute()))
                result.attributes.push_back({attribute.name(), text->value()});
        return result;
    });
}

ExrFile read_exr(const fs::path& path) {
    const std::string bytes = read_file(path);
    if (!std::string_view(bytes).starts_with("\x76\x2f\x31\x01"))
        throw Error(message(path.string(), ": not an EXR file"));
    return decode_exr_channels({path.string(), bytes});
}

void write_exr(const fs::path& path, int width, int height, const std::vector<ExrChannel>& channels,
               const std::vector<ExrAttribute>& attributes) {
    check_written_size(path.string(), width, height);
    Imf::Header header(width, height);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer frame;
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const auto write = [&](const fs::path& temporary) {
        for (const ExrAttribute& attribute : attributes)
            header.insert(attribute.name, Imf::StringAttribute(attribute.value));
        for (const ExrChannel& channel : channels) {
            const bool integers = channel.floats.empty();
            DUET_CHECK_EQ(integers ? channel.integers.size() : channel.floats.size(), count);
            DUET_CHECK(integers || channel.integers.empty());
            DUET_CHECK(frame.findSlice(channel.name) == nullptr);
            const Imf::PixelType type = integers ? Imf::UINT : Imf::FLOAT;
            const void* values = integers ? static_cast<const void*>(channel.integers.data()) : channel.floats.data();
            header.channels().insert(channel.name, Imf::Channel(type));
            frame.insert(channel.name, slice(type, values, header.dataWindow()));
        }
        // Use a separate stream to detect errors: OpenEXR writes the table of offsets in a destructor, which does not
        // report a failure.
        std::ofstream out(temporary, std::ios::binary);
        check_written(out, path);
        {
            Imf::StdOFStream stream(out, path.string().c_str());
            Imf::OutputFile output(stream, header, exr_threads(static_cast<double>(count * channels.size())));
            output.setFrameBuffer(frame);
            output.writePixels(height);
        }
        out.close();
        check_written(out, path);
    };
    write_atomically(path, [&](const fs::path& temporary) {
        convert_errors(path.string() + ": cannot be written", 1, [&] { write(temporary); });
    });
}

} // namespace duet
