// This file defines a pool of objects whose memory is reused.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace duet {

/// Lends objects to threads, which may take them at the same time. A returned object keeps its state and is lent again.
template <typename T> class ObjectPool {
public:
    /// Returns a borrowed object to its pool, which must still exist.
    struct Return {
        ObjectPool* pool;

        void operator()(T* object) const {
            const std::lock_guard lock(pool->mutex_);
            pool->free_.emplace_back(object);
        }
    };

    /// Returns an object that no other thread uses. It goes back to the pool when the pointer is destroyed. If all
    /// objects are lent, it is a new one, constructed from `arguments`.
    template <typename... Arguments> std::unique_ptr<T, Return> take(const Arguments&... arguments) {
        const std::lock_guard lock(mutex_);
        if (free_.empty()) return {std::make_unique<T>(arguments...).release(), {this}};
        std::unique_ptr<T> object = std::move(free_.back());
        free_.pop_back();
        return {object.release(), {this}};
    }

private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<T>> free_;
};

} // namespace duet
