// Memory that begins with a line of the cache.
#pragma once

#include <cstddef>
#include <new>

namespace duet {

/// An allocator for std::vector: what lies there in whole lines is stored in whole lines. (An ordinary allocator's memory
/// begins 16 bytes into a line, and every wide store falls onto two.)
template <typename T> struct CacheAligned {
    using value_type = T;
    static constexpr std::align_val_t kLine{64};

    CacheAligned() = default;
    template <typename U> CacheAligned(const CacheAligned<U>&) noexcept {}
    T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kLine)); }
    void deallocate(T* memory, std::size_t) noexcept { ::operator delete(memory, kLine); }
    template <typename U> friend bool operator==(const CacheAligned&, const CacheAligned<U>&) { return true; }
};

} // namespace duet
