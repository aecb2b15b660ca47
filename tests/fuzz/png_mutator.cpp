// This mutator of libFuzzer corrects the checksums of a PNG, which would reject nearly every mutated input before it is
// decoded.
#include <cstddef>
#include <cstdint>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
    size = LLVMFuzzerMutate(data, size, max_size);
    const auto byte_at = [&](std::size_t i) { return static_cast<std::uint32_t>(data[i]); };
    const std::uint8_t signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    if (size < sizeof signature || seed % 16 == 0) return size;
    for (std::size_t i = 0; i < sizeof signature; ++i)
        if (data[i] != signature[i]) return size;
    for (std::size_t at = 8; at + 12 <= size;) {
        const std::size_t length = byte_at(at) << 24 | byte_at(at + 1) << 16 | byte_at(at + 2) << 8 | byte_at(at + 3);
        if (length > size - at - 12) break;
        std::uint32_t crc = 0xffffffffu;
        for (std::size_t i = at + 4; i < at + 8 + length; ++i) {
            crc ^= data[i];
            for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? 0xedb88320u ^ crc >> 1 : crc >> 1;
        }
        for (unsigned i = 0; i < 4; ++i) data[at + 8 + length + i] = static_cast<std::uint8_t>(~crc >> (24 - 8 * i));
        at += 12 + length;
    }
    return size;
}
