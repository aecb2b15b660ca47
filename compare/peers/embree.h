// Embree's ray kernels as a peer: the same triangles, the same rays. Optional: compiled in where it is installed.
#pragma once

#include "common/geometry/shape.h"
#include "compare/kernels/tracer.h"

#include <memory>
#include <string>
#include <vector>

namespace duet::compare {

/// "embree 3.13.5", or empty where this program was built without it.
std::string embree_version();

/// How a hierarchy is built and traced: RTC_BUILD_QUALITY_MEDIUM or _HIGH (spatial splits), RTC_SCENE_FLAG_ROBUST or
/// not.
struct EmbreeQuality {
    bool high = false, robust = false;

    friend bool operator==(const EmbreeQuality&, const EmbreeQuality&) = default;
};
/// "medium", "medium-robust", "high", "high-robust".
std::string name_of(EmbreeQuality quality);

/// Embree's threads, its widest instruction set, its account of memory; and the mesh in the form it asks for (the last
/// vertex must be followed by readable memory). Refers to the mesh. Throws Error (exit code 1) where Embree fails, and
/// where this program was built without it.
class EmbreeDevice {
public:
    /// threads: for building, at least 1.
    EmbreeDevice(const Mesh& mesh, int threads);

    struct Handle;
    const std::shared_ptr<Handle>& handle() const { return handle_; }

private:
    std::shared_ptr<Handle> handle_;
};

/// The mesh's hierarchy; built by the constructor, from the triangles to a committed scene.
class EmbreeScene {
public:
    EmbreeScene(const EmbreeDevice& device, EmbreeQuality quality);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    /// What Embree allocated since the scene was begun and still holds, as its memory monitor is told; without the
    /// caller's vertices and indices, which it uses where they are.
    std::int64_t memory_bytes() const;

    /// rtcIntersect1 (width 1), or packets of 8 or 16 consecutive rays (rtcIntersect8, rtcIntersect16), laid out in
    /// memory beforehand; `coherent` sets the flag of that name. Denormals are flushed to zero meanwhile, as Embree's
    /// manual recommends. The scene and the rays must outlive the tracer.
    Tracer closest(std::span<const Ray> rays, int width, bool coherent) const;
    /// rtcOccluded1.
    Tracer occluded(std::span<const Ray> rays) const;

private:
    struct Built;
    std::unique_ptr<Built> built_;
};

} // namespace duet::compare
