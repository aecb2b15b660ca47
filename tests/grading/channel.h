// This file declares the pipes between the examiner and a worker: each message is its length and its bytes.
#pragma once

#include "tests/grading/wire.h"

#include <cerrno>
#include <unistd.h>

namespace duet::grading {

inline constexpr int kRequestDescriptor = 3, kReplyDescriptor = 4; ///< as the worker sees them

/// How a call ended in the worker.
enum class Outcome : std::uint8_t { kReturned, kThrew, kOutOfMemory };

/// Writes all bytes; false where the other end is gone.
inline bool send_bytes(int descriptor, const char* bytes, std::size_t size) {
    while (size > 0) {
        const ssize_t written = ::write(descriptor, bytes, size);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        bytes += written;
        size -= static_cast<std::size_t>(written);
    }
    return true;
}
/// A message as it is sent: its length, then its bytes.
inline std::string with_length_prefix(const std::string& message) {
    const std::uint64_t size = message.size();
    std::string bytes(reinterpret_cast<const char*>(&size), sizeof size);
    return bytes += message;
}
inline bool send(int descriptor, const std::string& message) {
    const std::string bytes = with_length_prefix(message);
    return send_bytes(descriptor, bytes.data(), bytes.size());
}

/// Reads that many bytes; false where the other end closed.
inline bool receive_bytes(int descriptor, char* bytes, std::size_t size) {
    while (size > 0) {
        const ssize_t got = ::read(descriptor, bytes, size);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        bytes += got;
        size -= static_cast<std::size_t>(got);
    }
    return true;
}
inline bool receive(int descriptor, std::string& message) {
    std::uint64_t size = 0;
    if (!receive_bytes(descriptor, reinterpret_cast<char*>(&size), sizeof size) || size > kMaxMessage) return false;
    message.resize(size);
    return receive_bytes(descriptor, message.data(), size);
}

} // namespace duet::grading
