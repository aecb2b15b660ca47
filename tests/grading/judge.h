// The examiner of a lab: items that call the student's functions in a process of their own, and judge what comes back.
//
//     LAB_TITLE("raytrace-02", "A ray meets a sphere")
//     LAB_ITEM(10, "a ray through the center meets the front of the sphere") {
//         const auto t = STUDENT(hit_sphere)(Vec3{0, 0, -3}, 1.0f, Ray{{0, 0, 0}, {0, 0, -1}});
//         item.require(t.has_value(), "The ray passes through the center, so it hits; your function returned no hit.");
//         item.near("the distance", *t, 2.0f, 1e-5f, {{4.0f, "This is the back of the sphere."}});
//     }
//
// The first check that fails ends its item. An item gives all its points or none; one of 0 points only shows something.
#pragma once

#include "common/image/image.h"
#include "common/system/error.h"
#include "tests/grading/describe.h"
#include "tests/grading/session.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace duet::grading {

/// A wrong value that a typical mistake gives, and what to tell the student who made it.
template <typename T> struct Mistake {
    T value;
    std::string text;
};

/// A way to compute that is a typical mistake, and what to tell the student who does it so.
template <typename Way> struct WrongMethod {
    Way way;
    std::string text;
};
/// The text of the first way that gives all that was found: by(i, way) is what a way gives for found[i]. "" where none
/// does.
template <typename Way, typename By>
std::string matching_mistake(const std::vector<float>& found, const std::vector<WrongMethod<Way>>& ways, const By& by) {
    for (const auto& [way, text] : ways) {
        bool explains = true;
        for (std::size_t i = 0; i < found.size() && explains; ++i) explains = is_near(found[i], by(i, way), 1e-4);
        if (explains) return text;
    }
    return "";
}

/// Random numbers that depend on the seed of the grading and on the item alone (SplitMix64, Steele et al. 2014).
class Rng {
public:
    explicit Rng(std::uint64_t seed) : state_(seed) {}
    std::uint64_t bits();
    double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; } ///< in [0, 1)
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    int integer(int low, int high); ///< both ends included
    Vec3d unit_vector();            ///< evenly over the sphere

private:
    std::uint64_t state_;
};

/// Ends an item: what is wrong, and a drawing of it where there is one.
struct ItemFailed {
    std::string text, expected, found, map;
};

/// An image that the result page shows.
struct ShownImage {
    std::string name, file;
};

/// What an item's checks need.
class Item {
public:
    Item(std::uint64_t seed, std::string out_folder, int index)
        : rng_(seed), out_(std::move(out_folder)), index_(index) {}

    Rng& random() { return rng_; }
    /// The time that each following call may take, in seconds of processor time (2 unless told).
    void limit(double seconds) { session().limit(seconds); }
    /// The processor time of the last call. Compare it with processor time (std::clock), not with a clock on the wall.
    double seconds() const { return session().last_seconds(); }

    /// What the following calls are about, in a sentence: it ends the message where one of them crashes or hangs.
    void about(const std::string& text) { about_ = text; }
    const std::string& about() const { return about_; }

    void require(bool ok, const std::string& text) {
        if (!ok) throw ItemFailed{text, "", "", ""};
    }
    /// All components of `found` within `tolerance` of those of `expected`: numbers, vectors, colors, optionals and
    /// lists of them.
    template <typename T>
    void near(const std::string& what, const T& found, const std::type_identity_t<T>& expected, double tolerance,
              const std::vector<Mistake<std::type_identity_t<T>>>& mistakes = {}) {
        if (is_near(found, expected, tolerance)) return;
        std::string hint;
        for (const auto& mistake : mistakes)
            if (hint.empty() && is_near(found, mistake.value, tolerance)) hint = mistake.text;
        fail(what, hint.empty() ? explain_difference(found, expected, tolerance) : hint, expected, found);
    }
    /// Exactly equal.
    template <typename T>
    void equal(const std::string& what, const T& found, const std::type_identity_t<T>& expected,
               const std::vector<Mistake<std::type_identity_t<T>>>& mistakes = {}) {
        if (found == expected) return;
        std::string hint;
        for (const auto& mistake : mistakes)
            if (hint.empty() && found == mistake.value) hint = mistake.text;
        fail(what, hint, expected, found);
    }
    /// Each pixel's components within `tolerance`. Found, expected and difference go to the page, and the message has a
    /// map of the wrong pixels. A mistake's image need only be nearer to what was found than the expected one is.
    void image(const std::string& name, const ImageRgb& found, const ImageRgb& expected, double tolerance,
               const std::vector<Mistake<ImageRgb>>& mistakes = {});
    /// The same for numbers, which the page shows as gray.
    void image(const std::string& name, const ImageFloat& found, const ImageFloat& expected, double tolerance,
               const std::vector<Mistake<ImageFloat>>& mistakes = {});
    /// An image has the size that the contract says.
    template <typename Pixel> void size(const Image<Pixel>& found, int width, int height) {
        require(found.width() == width && found.height() == height,
                message("The result has ", found.width(), " × ", found.height(), " pixels; expected ", width, " × ",
                        height, "."));
    }
    /// How many times each pixel is covered. The map shows missing (-), doubled (2) and extra (+) pixels.
    void coverage(const std::string& name, const Image<int>& found, const Image<int>& expected,
                  const std::vector<Mistake<Image<int>>>& mistakes = {});
    /// On the page, not judged. Linear color.
    void show(const std::string& name, const ImageRgb& image);
    void show(const std::string& name, const ImageFloat& image);
    const std::vector<ShownImage>& images() const { return images_; }

private:
    template <typename T>
    [[noreturn]] void fail(const std::string& what, const std::string& hint, const T& expected, const T& found) {
        throw ItemFailed{what + " is wrong." + (hint.empty() ? "" : " " + hint), describe(expected), describe(found),
                         ""};
    }
    Rng rng_;
    std::string out_, about_;
    int index_;
    std::vector<ShownImage> images_;
};

/// A student's function, callable as if it were here.
template <typename Function> class RemoteFunction;
template <typename Result, typename... Args> class RemoteFunction<Result(Args...)> {
public:
    explicit RemoteFunction(const char* name) : name_(name) {}
    std::remove_cvref_t<Result> operator()(const std::type_identity_t<std::remove_cvref_t<Args>>&... args) const {
        Writer request;
        request.put(std::string(name_));
        (request.put<std::remove_cvref_t<Args>>(args), ...);
        const std::string reply = session().call(name_, request.bytes());
        return decode<std::remove_cvref_t<Result>>(reply);
    }

private:
    template <typename T> static T decode(const std::string& bytes) {
        try {
            Reader in(bytes);
            T value = in.get<T>();
            if (!in.at_end()) throw WireError("there is more than the answer");
            return value;
        } catch (const WireError& error) {
            throw CallFailed{std::string("The answer is malformed: ") + error.what() + "."};
        }
    }
    const char* name_;
};

struct ItemDefinition {
    int points;
    std::string title;
    void (*run)(Item&);
};
/// Returns the lab's items, in the order of the file.
std::vector<ItemDefinition>& items();
struct LabTitle {
    std::string id, title;
};
LabTitle& lab_title();
inline bool add_item(int points, const char* title, void (*run)(Item&)) {
    items().push_back({points, title, run});
    return true;
}
inline bool set_title(const char* id, const char* title) {
    lab_title() = {id, title};
    return true;
}

} // namespace duet::grading

#define DUET_GRADING_JOIN_(a, b) a##b
#define DUET_GRADING_JOIN(a, b) DUET_GRADING_JOIN_(a, b)
/// The function of the student's with that name.
#define STUDENT(f) (::duet::grading::RemoteFunction<decltype(::duet::lab::f)>(#f))
#define LAB_TITLE(id, title) [[maybe_unused]] static const bool duet_lab_title = ::duet::grading::set_title(id, title);
#define LAB_ITEM(points, title)                                                                                        \
    static void DUET_GRADING_JOIN(duet_item_, __LINE__)(::duet::grading::Item & item);                                 \
    [[maybe_unused]] static const bool DUET_GRADING_JOIN(duet_item_added_, __LINE__) =                                 \
        ::duet::grading::add_item(points, title, &DUET_GRADING_JOIN(duet_item_, __LINE__));                            \
    static void DUET_GRADING_JOIN(duet_item_, __LINE__)([[maybe_unused]] ::duet::grading::Item & item)
