// This file defines the allocator of images and other large arrays: aligned to cache lines, and in huge pages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <utility>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace duet {

inline constexpr std::size_t kHugePage = std::size_t{2} << 20; ///< bytes

/// Asks the system to use huge pages for a block of memory, which may be null, where it offers the choice (on Linux,
/// transparent huge pages by `madvise`). They reduce the page faults at the first write, which take longer than the
/// write itself, and TLB misses where memory is read in random order.
inline void request_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
    const auto start = reinterpret_cast<std::uintptr_t>(memory), offset = (0 - start) % kHugePage;
    if (memory == nullptr || bytes < offset + kHugePage) return;
    madvise(static_cast<char*>(memory) + offset, bytes - offset, MADV_HUGEPAGE); // failure is harmless
#endif
}

/// This allocator aligns memory to cache lines of 64 bytes, so that a 64-byte SIMD store at a multiple of 64 bytes
/// writes one line. (The memory of an ordinary allocator starts 16 bytes into a line, and each such store touches two.)
///
/// It aligns blocks of at least two huge pages to huge pages, and requests these wherever a block contains whole ones.
///
/// Elements are default-initialized: resizing a vector leaves new elements of trivial types uninitialized, so that
/// large vectors are written only once.
template <typename T> struct HugePageAllocator {
    using value_type = T;

    HugePageAllocator() = default;
    template <typename U> HugePageAllocator(const HugePageAllocator<U>&) {}

    T* allocate(std::size_t count) {
        const std::size_t bytes = count * sizeof(T);
        const std::size_t alignment = bytes >= 2 * kHugePage ? kHugePage : std::size_t{64};
        void* memory = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
        if (memory == nullptr) throw std::bad_alloc();
        request_huge_pages(memory, bytes);
        return static_cast<T*>(memory);
    }
    template <typename U> void construct(U* element) { ::new (static_cast<void*>(element)) U; }
    template <typename U, typename... Args> void construct(U* element, Args&&... args) {
        ::new (static_cast<void*>(element)) U(std::forward<Args>(args)...);
    }
    void deallocate(T* memory, std::size_t) { std::free(memory); }

    friend bool operator==(const HugePageAllocator&, const HugePageAllocator&) { return true; }
};

} // namespace duet
