#include "common/sampling/digest.h"

#include "common/sampling/hash.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace duet {

std::uint64_t hash_bytes(std::uint64_t state, std::string_view bytes) {
    state = hash_combine(state, bytes.size());
    for (std::size_t at = 0; at < bytes.size(); at += 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data() + at, std::min<std::size_t>(8, bytes.size() - at));
        state = hash_combine(state, word);
    }
    return state;
}

std::string to_hex(std::uint64_t value) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
    return text;
}

} // namespace duet
