// This file defines an allocator whose memory starts at a cache-line boundary.
#pragma once

#include <cstddef>
#include <new>

namespace duet {

/// This allocator for std::vector aligns memory to 64 bytes, so that a 64-byte SIMD store at a multiple of 64 bytes
/// writes one cache line. The memory of an ordinary allocator starts 16 bytes into a line, and each such store touches
/// two.
template <typename T> struct CacheAlignedAllocator {
    using value_type = T;
    static constexpr std::align_val_t kLine{64};

    CacheAlignedAllocator() = default;
    template <typename U> CacheAlignedAllocator(const CacheAlignedAllocator<U>&) noexcept {}
    T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kLine)); }
    void deallocate(T* memory, std::size_t) noexcept { ::operator delete(memory, kLine); }
    template <typename U> friend bool operator==(const CacheAlignedAllocator&, const CacheAlignedAllocator<U>&) {
        return true;
    }
};

} // namespace duet
