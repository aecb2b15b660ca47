// Memory that is read at random, in large pages: fewer translations miss.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <utility>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace duet {

/// An allocator of cache-line-aligned memory; blocks of several large pages (2 MiB) are aligned to them, and the system
/// is asked for such pages where it leaves the choice to programs (Linux: transparent huge pages, `madvise`). A vector
/// that is resized leaves new elements of plain types without a value: large ones are written once.
template <typename T> struct HugePageAllocator {
    using value_type = T;

    HugePageAllocator() = default;
    template <typename U> HugePageAllocator(const HugePageAllocator<U>&) {}

    T* allocate(std::size_t count) {
        constexpr std::size_t kPage = std::size_t{2} << 20;
        const std::size_t bytes = count * sizeof(T);
        const std::size_t alignment = bytes >= 2 * kPage ? kPage : std::size_t{64};
        void* memory = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
        if (memory == nullptr) throw std::bad_alloc();
#if defined(__linux__)
        if (alignment == kPage) madvise(memory, bytes, MADV_HUGEPAGE); // advice: a refusal changes nothing
#endif
        return static_cast<T*>(memory);
    }
    template <typename U> void construct(U* place) { ::new (static_cast<void*>(place)) U; }
    template <typename U, typename... Args> void construct(U* place, Args&&... args) {
        ::new (static_cast<void*>(place)) U(std::forward<Args>(args)...);
    }
    void deallocate(T* memory, std::size_t) { std::free(memory); }

    friend bool operator==(const HugePageAllocator&, const HugePageAllocator&) { return true; }
};

} // namespace duet
