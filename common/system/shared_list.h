// A SharedList stores elements that copies of the list share.
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace duet {

/// A SharedList is a list whose copies share the elements, so that copying it costs little however large the elements
/// are. An element does not change while another list shares it: edit() copies it first.
template <typename T> class SharedList {
public:
    SharedList() = default;
    SharedList(std::initializer_list<T> elements) {
        for (const T& element : elements) push_back(element);
    }
    explicit SharedList(std::vector<T> elements) {
        for (T& element : elements) push_back(std::move(element));
    }

    std::size_t size() const { return elements_.size(); }
    bool empty() const { return elements_.empty(); }
    const T& operator[](std::size_t i) const { return *elements_[i]; }
    const T& front() const { return *elements_.front(); }

    void push_back(T element) { push_back(std::make_shared<T>(std::move(element))); }
    /// Appends an element that another list, or a cache, may share. It must have been made as a T that is not const.
    void push_back(std::shared_ptr<const T> element) { elements_.push_back(std::move(element)); }
    /// Returns an element to change. If another list shares it, it is copied first.
    T& edit(std::size_t i) {
        if (elements_[i].use_count() > 1) elements_[i] = std::make_shared<T>(*elements_[i]);
        return const_cast<T&>(*elements_[i]); // no other list sees the change
    }
    /// Returns the element as it is shared. Lists that share an element return the same pointer.
    const std::shared_ptr<const T>& shared(std::size_t i) const { return elements_[i]; }
    /// Returns the index of an element that this list shares, or size() if it does not. Looks at the index `guess`
    /// first, and takes time proportional to the size if the element is elsewhere.
    std::size_t index_of(const std::shared_ptr<const T>& element, std::size_t guess) const {
        if (guess < size() && elements_[guess] == element) return guess;
        return static_cast<std::size_t>(std::find(elements_.begin(), elements_.end(), element) - elements_.begin());
    }

private:
    std::vector<std::shared_ptr<const T>> elements_;
};

} // namespace duet
