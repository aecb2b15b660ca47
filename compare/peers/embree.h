// This file declares Embree's ray kernels as a peer that traces the same triangles with the same rays. They are
// compiled in only if Embree is installed.
#pragma once

#include "common/scene/scene.h"
#include "compare/kernels/tracer.h"

#include <memory>
#include <string>
#include <vector>

namespace duet::compare {

/// Returns the version, such as "embree 3.13.5"; empty if this program was built without Embree.
std::string embree_version();

/// Holds Embree's settings for building and traversing a BVH: RTC_BUILD_QUALITY_MEDIUM or _HIGH (spatial splits), with
/// or without RTC_SCENE_FLAG_ROBUST, and with the widest instructions of the CPU or with AVX2, which is faster than
/// AVX-512 on some CPUs.
struct EmbreeQuality {
    bool high = false, robust = false, avx2 = false;

    friend bool operator==(const EmbreeQuality&, const EmbreeQuality&) = default;
};
/// Returns "medium", "medium-robust", "high" or "high-robust", followed by "-avx2" if the quality uses AVX2.
std::string name_of(EmbreeQuality quality);
/// Returns the settings that differ on this CPU. Without AVX-512, AVX2 is already the widest. The list is empty without
/// Embree.
std::vector<EmbreeQuality> embree_qualities();

/// Selects the form in which rays are passed to Embree. Streams exist only in Embree 3: rtcIntersect1M (an array of
/// structures) and rtcIntersectNp (a structure of arrays).
enum class EmbreeForm { kSingle, kPackets8, kPackets16, kStreamM, kStreamNp };
/// Returns the forms for many rays at once that the installed version of Embree supports.
std::vector<EmbreeForm> embree_bulk_forms();

/// An EmbreeDevice has its own threads, instruction set and memory monitor. It also holds the scene's vertices in the
/// form that Embree requires: readable memory must follow the last vertex. It keeps a reference to the scene, which
/// must contain only meshes. Throws Error (exit code 1) if Embree fails or this program was built without it.
class EmbreeDevice {
public:
    /// The build uses `threads` threads, at least 1. With `avx2`, Embree uses AVX2 instead of the widest instructions.
    EmbreeDevice(const Scene& scene, int threads, bool avx2 = false);

    struct Handle;
    const std::shared_ptr<Handle>& handle() const { return handle_; }

private:
    std::shared_ptr<Handle> handle_;
};

/// An EmbreeScene is a BVH of the scene, with two levels if the scene has instances. The constructor performs the whole
/// build, from the triangles to a committed scene.
class EmbreeScene {
public:
    /// The device must use AVX2 if and only if the quality does.
    EmbreeScene(const EmbreeDevice& device, EmbreeQuality quality);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    /// Returns the memory in bytes that Embree allocated for this scene and still holds, as reported to its
    /// memory monitor. It excludes the caller's vertices and indices, which Embree uses in place.
    std::int64_t memory_bytes() const;

    /// Returns a tracer for closest hits: rtcIntersect1, or packets or streams of consecutive rays. Packets and
    /// streams are laid out in memory in advance; a stream is copied before each call, because Embree
    /// overwrites it with the hits. `coherent` sets Embree's flag of that name. Denormals are flushed to zero
    /// during tracing, as Embree's manual recommends. The scene and the rays must outlive the tracer.
    Tracer closest(std::span<const Ray> rays, EmbreeForm form, bool coherent) const;
    /// Returns a tracer for occlusion by rtcOccluded1. The scene and the rays must outlive the tracer.
    Tracer occluded(std::span<const Ray> rays) const;

private:
    struct BuiltScene;
    std::unique_ptr<BuiltScene> built_;
};

} // namespace duet::compare
