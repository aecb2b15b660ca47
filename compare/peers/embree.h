// Embree's ray kernels as a peer: the same triangles, the same rays. Optional: compiled in where it is installed.
#pragma once

#include "common/scene/scene.h"
#include "compare/kernels/tracer.h"

#include <memory>
#include <string>
#include <vector>

namespace duet::compare {

/// "embree 3.13.5", or empty where this program was built without it.
std::string embree_version();

/// How a hierarchy is built and traced: RTC_BUILD_QUALITY_MEDIUM or _HIGH (spatial splits), RTC_SCENE_FLAG_ROBUST or
/// not, with the processor's widest instructions or with AVX2, which on some processors is faster than AVX-512.
struct EmbreeQuality {
    bool high = false, robust = false, avx2 = false;

    friend bool operator==(const EmbreeQuality&, const EmbreeQuality&) = default;
};
/// "medium", "medium-robust", "high", "high-robust"; with "-avx2" behind them.
std::string name_of(EmbreeQuality quality);
/// What is worth trying on this machine: without AVX-512 the widest is AVX2 already. Empty without Embree.
std::vector<EmbreeQuality> embree_qualities();

/// How rays are handed over. Streams are Embree 3's (rtcIntersect1M; rtcIntersectNp: arrays of one quantity each).
enum class EmbreeForm { kSingle, kPackets8, kPackets16, kStreamM, kStreamNp };
/// The forms that this version knows for many rays at once.
std::vector<EmbreeForm> embree_bulk_forms();

/// Embree's threads, its instruction set, its account of memory; and the scene's meshes in the form it asks for
/// (the last vertex must be followed by readable memory). Refers to the scene, which has nothing but meshes.
/// Throws Error (exit code 1) where Embree fails, and where this program was built without it.
class EmbreeDevice {
public:
    /// threads: for building, at least 1. avx2: with AVX2 rather than the widest instructions.
    EmbreeDevice(const Scene& scene, int threads, bool avx2 = false);

    struct Handle;
    const std::shared_ptr<Handle>& handle() const { return handle_; }

private:
    std::shared_ptr<Handle> handle_;
};

/// The scene's hierarchy, of two levels where it has instances; built by the constructor, from the triangles to a
/// committed scene.
class EmbreeScene {
public:
    /// Of a device with or without AVX2, as the quality says.
    EmbreeScene(const EmbreeDevice& device, EmbreeQuality quality);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    /// What Embree allocated since the scene was begun and still holds, as its memory monitor is told; without the
    /// caller's vertices and indices, which it uses where they are.
    std::int64_t memory_bytes() const;

    /// rtcIntersect1, or packets or streams of consecutive rays, laid out in memory beforehand; a stream is copied, as it
    /// is overwritten with the hits. `coherent` sets the flag of that name. Denormals are flushed to zero meanwhile, as
    /// Embree's manual recommends. The scene and the rays must outlive the tracer.
    Tracer closest(std::span<const Ray> rays, EmbreeForm form, bool coherent) const;
    /// rtcOccluded1.
    Tracer occluded(std::span<const Ray> rays) const;

private:
    struct Built;
    std::unique_ptr<Built> built_;
};

} // namespace duet::compare
