// Values as bytes, for calls between the examiner and the process that runs a student's code.
//
// Both ends are compiled on one machine, so numbers travel as they lie in memory. The reader trusts nothing: each
// length is checked against the bytes that are there.
#pragma once

#include "common/image/image.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace duet::grading {

/// The most bytes that one call or one answer may have.
inline constexpr std::size_t kMaxMessage = std::size_t{64} << 20;

/// Bytes that don't hold what is read from them.
struct WireError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

namespace detail {

/// Stands for a value of any type where the members of an aggregate are counted; never evaluated.
struct Any {
    template <typename T> operator T() const;
};
template <typename T, typename... Members> constexpr std::size_t count_members() {
    if constexpr (requires { T{Members{}..., Any{}}; })
        return count_members<T, Members..., Any>();
    else
        return sizeof...(Members);
}

/// Calls visit(member) for each member of a plain struct of at most ten.
template <typename T, typename Visit> void for_each_member(T& value, const Visit& visit) {
    constexpr std::size_t kCount = count_members<std::remove_const_t<T>>();
    static_assert(kCount >= 1 && kCount <= 10, "a struct of a lab's contract has 1 to 10 members and no constructor");
    const auto all = [&](auto&... members) { (visit(members), ...); };
    if constexpr (kCount == 1) {
        auto& [a] = value;
        all(a);
    } else if constexpr (kCount == 2) {
        auto& [a, b] = value;
        all(a, b);
    } else if constexpr (kCount == 3) {
        auto& [a, b, c] = value;
        all(a, b, c);
    } else if constexpr (kCount == 4) {
        auto& [a, b, c, d] = value;
        all(a, b, c, d);
    } else if constexpr (kCount == 5) {
        auto& [a, b, c, d, e] = value;
        all(a, b, c, d, e);
    } else if constexpr (kCount == 6) {
        auto& [a, b, c, d, e, f] = value;
        all(a, b, c, d, e, f);
    } else if constexpr (kCount == 7) {
        auto& [a, b, c, d, e, f, g] = value;
        all(a, b, c, d, e, f, g);
    } else if constexpr (kCount == 8) {
        auto& [a, b, c, d, e, f, g, h] = value;
        all(a, b, c, d, e, f, g, h);
    } else if constexpr (kCount == 9) {
        auto& [a, b, c, d, e, f, g, h, i] = value;
        all(a, b, c, d, e, f, g, h, i);
    } else {
        auto& [a, b, c, d, e, f, g, h, i, j] = value;
        all(a, b, c, d, e, f, g, h, i, j);
    }
}

template <typename T> inline constexpr bool kIsVector = false;
template <typename T, typename A> inline constexpr bool kIsVector<std::vector<T, A>> = true;
template <typename T> inline constexpr bool kIsOptional = false;
template <typename T> inline constexpr bool kIsOptional<std::optional<T>> = true;
template <typename T> inline constexpr bool kIsImage = false;
template <typename T> inline constexpr bool kIsImage<Image<T>> = true;
template <typename T> inline constexpr bool kIsArray = false;
template <typename T, std::size_t N> inline constexpr bool kIsArray<std::array<T, N>> = true;

} // namespace detail

/// Appends values to a string of bytes.
class Writer {
public:
    template <typename T> void put(const T& value) {
        if constexpr (detail::kIsOptional<T>) {
            put(value.has_value());
            if (value) put(*value);
        } else if constexpr (std::is_same_v<T, std::string> || detail::kIsVector<T>) {
            put(static_cast<std::uint64_t>(value.size()));
            put_all(value);
        } else if constexpr (detail::kIsImage<T>) {
            put(value.width()), put(value.height());
            put_all(value.pixels());
        } else if constexpr (std::is_trivially_copyable_v<T>) {
            static_assert(!std::is_pointer_v<T>, "a lab's contract has no pointers: they mean nothing elsewhere");
            bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
        } else if constexpr (detail::kIsArray<T>) {
            put_all(value);
        } else {
            detail::for_each_member(value, [this](const auto& member) { put(member); });
        }
    }
    const std::string& bytes() const { return bytes_; }

private:
    template <typename Range> void put_all(const Range& range) {
        for (const auto& element : range) put<typename Range::value_type>(element);
    }
    std::string bytes_;
};

/// Takes the values out again, in the same order. Throws WireError where the bytes end too soon.
class Reader {
public:
    explicit Reader(std::string_view bytes) : bytes_(bytes) {}

    template <typename T> T get() {
        if constexpr (detail::kIsOptional<T>) {
            if (!get<bool>()) return std::nullopt;
            return get<typename T::value_type>();
        } else if constexpr (std::is_same_v<T, std::string> || detail::kIsVector<T>) {
            const auto count = get<std::uint64_t>();
            if (count > bytes_.size()) throw WireError("a list is longer than the message that it came in");
            T list;
            for (std::uint64_t i = 0; i < count; ++i) list.push_back(get<typename T::value_type>());
            return list;
        } else if constexpr (detail::kIsImage<T>) {
            const int width = get<int>(), height = get<int>();
            if (width < 0 || height < 0 || width > kMaxRenderSide || height > kMaxRenderSide ||
                static_cast<std::size_t>(width) * static_cast<std::size_t>(height) > bytes_.size())
                throw WireError("an image is larger than the message that it came in");
            T image(width, height);
            for (std::size_t i = 0; i < image.size(); ++i) image[i] = get<std::remove_cvref_t<decltype(image[i])>>();
            return image;
        } else if constexpr (std::is_same_v<T, bool>) {
            return get<char>() != 0; // another bit pattern in a bool would be undefined behavior
        } else if constexpr (std::is_trivially_copyable_v<T>) {
            if (bytes_.size() < sizeof(T)) throw WireError("a message ends too soon");
            T value;
            std::memcpy(static_cast<void*>(&value), bytes_.data(), sizeof value);
            bytes_.remove_prefix(sizeof value);
            return value;
        } else {
            T value{};
            const auto fill = [this](auto& member) { member = get<std::remove_cvref_t<decltype(member)>>(); };
            if constexpr (detail::kIsArray<T>)
                for (auto& element : value) fill(element);
            else
                detail::for_each_member(value, fill);
            return value;
        }
    }
    bool at_end() const { return bytes_.empty(); }

private:
    std::string_view bytes_;
};

} // namespace duet::grading
