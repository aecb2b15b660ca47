#include "compare/peers/embree.h"

#include "common/system/error.h"

#if defined(DUET_EMBREE)
#include <atomic>
#include <cstring>
#if DUET_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#if defined(__SSE__)
#include <xmmintrin.h>
#endif
#endif

namespace duet::compare {

std::string name_of(EmbreeQuality quality) {
    return std::string(quality.high ? "high" : "medium") + (quality.robust ? "-robust" : "");
}

#if defined(DUET_EMBREE)

std::string embree_version() {
    return message("embree ", RTC_VERSION_MAJOR, '.', RTC_VERSION_MINOR, '.', RTC_VERSION_PATCH);
}

struct EmbreeDevice::Handle {
    RTCDevice device = nullptr;
    std::atomic<std::int64_t> bytes{0};
    std::vector<Vec3> positions;
    const Mesh* mesh = nullptr;

    ~Handle() {
        if (device != nullptr) rtcReleaseDevice(device);
    }
};

namespace {

void fail_on_error(RTCDevice device) {
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE)
        throw Error(message(embree_version(), " failed with error ", static_cast<int>(error)), 1);
}

/// Denormals count as zero while it lives, in this thread.
class FlushToZero {
public:
#if defined(__SSE__)
    FlushToZero() : before_(_mm_getcsr()) { _mm_setcsr(before_ | kFlushToZero | kDenormalsAreZero); }
    ~FlushToZero() { _mm_setcsr(before_); }
    FlushToZero(const FlushToZero&) = delete;
    FlushToZero& operator=(const FlushToZero&) = delete;

private:
    static constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040;
    unsigned before_;
#endif
};

/// What a query says of its rays besides themselves: Embree 3's context, Embree 4's arguments.
#if DUET_EMBREE >= 4
struct Query {
    RTCIntersectArguments closest;
    RTCOccludedArguments any;
    explicit Query(bool coherent) {
        rtcInitIntersectArguments(&closest);
        rtcInitOccludedArguments(&any);
        closest.flags = any.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    }
};
void occluded1(RTCScene scene, Query& query, RTCRay& ray) { rtcOccluded1(scene, &ray, &query.any); }
void intersect1(RTCScene scene, Query& query, RTCRayHit& ray) { rtcIntersect1(scene, &ray, &query.closest); }
void intersect(const int* valid, RTCScene scene, Query& query, RTCRayHit8& rays) {
    rtcIntersect8(valid, scene, &rays, &query.closest);
}
void intersect(const int* valid, RTCScene scene, Query& query, RTCRayHit16& rays) {
    rtcIntersect16(valid, scene, &rays, &query.closest);
}
#else
struct Query {
    RTCIntersectContext context;
    explicit Query(bool coherent) {
        rtcInitIntersectContext(&context);
        context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    }
};
void occluded1(RTCScene scene, Query& query, RTCRay& ray) { rtcOccluded1(scene, &query.context, &ray); }
void intersect1(RTCScene scene, Query& query, RTCRayHit& ray) { rtcIntersect1(scene, &query.context, &ray); }
void intersect(const int* valid, RTCScene scene, Query& query, RTCRayHit8& rays) {
    rtcIntersect8(valid, scene, &query.context, &rays);
}
void intersect(const int* valid, RTCScene scene, Query& query, RTCRayHit16& rays) {
    rtcIntersect16(valid, scene, &query.context, &rays);
}
#endif

/// Embree's rays include their start, ours do not: what matters where they start at 0, on a surface.
float start_of(const Ray& ray) { return std::max(ray.t_min, std::numeric_limits<float>::min()); }

RTCRay as_embree(const Ray& ray) {
    return {ray.origin.x,
            ray.origin.y,
            ray.origin.z,
            start_of(ray),
            ray.direction.x,
            ray.direction.y,
            ray.direction.z,
            0,
            ray.t_max,
            0xffffffffu,
            0,
            0};
}

/// What a packet is made of, ready to be copied: arrays of one quantity each.
template <int kWidth> struct alignas(64) PacketRays {
    using Lanes = float[kWidth];
    Lanes org_x, org_y, org_z, tnear, dir_x, dir_y, dir_z, tfar;
    alignas(64) int valid[kWidth];
};

template <int kWidth> std::vector<PacketRays<kWidth>> packets_of(std::span<const Ray> rays) {
    std::vector<PacketRays<kWidth>> packets((rays.size() + kWidth - 1) / kWidth);
    for (std::size_t i = 0; i < packets.size() * kWidth; ++i) {
        PacketRays<kWidth>& packet = packets[i / kWidth];
        const std::size_t lane = i % kWidth;
        const Ray& ray = rays[std::min(i, rays.size() - 1)]; // lanes beyond the end are switched off
        packet.org_x[lane] = ray.origin.x, packet.org_y[lane] = ray.origin.y, packet.org_z[lane] = ray.origin.z;
        packet.dir_x[lane] = ray.direction.x, packet.dir_y[lane] = ray.direction.y;
        packet.dir_z[lane] = ray.direction.z;
        packet.tnear[lane] = start_of(ray), packet.tfar[lane] = ray.t_max;
        packet.valid[lane] = i < rays.size() ? -1 : 0;
    }
    return packets;
}

template <int kWidth> void load(const PacketRays<kWidth>& from, auto& ray) {
    constexpr std::size_t kBytes = sizeof(typename PacketRays<kWidth>::Lanes);
    std::memcpy(ray.org_x, from.org_x, kBytes);
    std::memcpy(ray.org_y, from.org_y, kBytes);
    std::memcpy(ray.org_z, from.org_z, kBytes);
    std::memcpy(ray.tnear, from.tnear, kBytes);
    std::memcpy(ray.dir_x, from.dir_x, kBytes);
    std::memcpy(ray.dir_y, from.dir_y, kBytes);
    std::memcpy(ray.dir_z, from.dir_z, kBytes);
    std::memcpy(ray.tfar, from.tfar, kBytes);
}

template <int kWidth, typename RayHit>
void trace_packets(RTCScene scene, Query& query, const std::vector<PacketRays<kWidth>>& packets, std::size_t block,
                   Answer* answers) {
    constexpr std::size_t kPackets = kBlock / kWidth;
    RayHit rays;
    std::memset(&rays, 0, sizeof rays);
    std::memset(rays.ray.mask, 0xff, sizeof rays.ray.mask);
    std::memset(rays.hit.instID, 0xff, sizeof rays.hit.instID);
    for (std::size_t p = block * kPackets; p < std::min(packets.size(), (block + 1) * kPackets); ++p) {
        load<kWidth>(packets[p], rays.ray);
        std::memset(rays.hit.geomID, 0xff, sizeof rays.hit.geomID); // RTC_INVALID_GEOMETRY_ID
        intersect(packets[p].valid, scene, query, rays);
        for (std::size_t lane = 0; lane < kWidth; ++lane)
            *answers++ = {rays.ray.tfar[lane],
                          rays.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID ? Answer::kNone : rays.hit.primID[lane]};
    }
}

template <int kWidth, typename RayHit>
std::function<void(std::size_t, Answer*)> packet_function(RTCScene scene, std::span<const Ray> rays, bool coherent) {
    const auto packets = std::make_shared<const std::vector<PacketRays<kWidth>>>(packets_of<kWidth>(rays));
    return [scene, packets, coherent](std::size_t block, Answer* answers) {
        const FlushToZero flush;
        Query query(coherent);
        trace_packets<kWidth, RayHit>(scene, query, *packets, block, answers);
    };
}

} // namespace

EmbreeDevice::EmbreeDevice(const Mesh& mesh, int threads) : handle_(std::make_shared<Handle>()) {
    // simd512: AVX-512 wherever the processor has it, whatever clock frequency Embree thinks it costs there.
    handle_->device = rtcNewDevice(message("threads=", threads, ",frequency_level=simd512").c_str());
    fail_on_error(handle_->device);
    rtcSetDeviceMemoryMonitorFunction(
        handle_->device,
        [](void* handle, ssize_t bytes, bool) {
            static_cast<Handle*>(handle)->bytes += bytes;
            return true;
        },
        handle_.get());
    handle_->mesh = &mesh;
    handle_->positions = mesh.positions;
    handle_->positions.emplace_back(); // a vertex is read as 16 bytes
}

struct EmbreeScene::Built {
    std::shared_ptr<EmbreeDevice::Handle> device;
    RTCScene scene = nullptr;
    std::int64_t bytes = 0;
};

EmbreeScene::EmbreeScene(const EmbreeDevice& device, EmbreeQuality quality) : built_(std::make_unique<Built>()) {
    EmbreeDevice::Handle& handle = *device.handle();
    built_->device = device.handle();
    const std::int64_t before = handle.bytes;
    built_->scene = rtcNewScene(handle.device);
    rtcSetSceneBuildQuality(built_->scene, quality.high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM);
    rtcSetSceneFlags(built_->scene, quality.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    RTCGeometry geometry = rtcNewGeometry(handle.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, quality.high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, handle.positions.data(), 0,
                               sizeof(Vec3), handle.positions.size() - 1);
    const auto& triangles = handle.mesh->triangles;
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0,
                               sizeof triangles[0], triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(built_->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(built_->scene);
    fail_on_error(handle.device);
    built_->bytes = handle.bytes - before;
}

EmbreeScene::~EmbreeScene() { rtcReleaseScene(built_->scene); }

std::int64_t EmbreeScene::memory_bytes() const { return built_->bytes; }

Tracer EmbreeScene::closest(std::span<const Ray> rays, int width, bool coherent) const {
    RTCScene scene = built_->scene;
    if (width == 16) return {"packets 16", packet_function<16, RTCRayHit16>(scene, rays, coherent)};
    if (width == 8) return {"packets 8", packet_function<8, RTCRayHit8>(scene, rays, coherent)};
    DUET_CHECK_EQ(width, 1);
    return {
        "", [scene, rays, coherent](std::size_t block, Answer* answers) {
            const FlushToZero flush;
            Query query(coherent);
            for (const Ray& ray : block_of(rays, block)) {
                RTCRayHit hit;
                hit.ray = as_embree(ray);
                hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
                hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
                intersect1(scene, query, hit);
                *answers++ = {hit.ray.tfar, hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? Answer::kNone : hit.hit.primID};
            }
        }};
}

Tracer EmbreeScene::occluded(std::span<const Ray> rays) const {
    RTCScene scene = built_->scene;
    return {"", [scene, rays](std::size_t block, Answer* answers) {
                const FlushToZero flush;
                Query query(false);
                for (const Ray& ray : block_of(rays, block)) {
                    RTCRay query_ray = as_embree(ray);
                    occluded1(scene, query, query_ray);
                    *answers++ = {ray.t_max, query_ray.tfar < 0 ? 0 : Answer::kNone}; // −infinity: blocked
                }
            }};
}

#else

// Without Embree nobody gets as far as this: the version is empty.
std::string embree_version() { return {}; }
struct EmbreeDevice::Handle {};
EmbreeDevice::EmbreeDevice(const Mesh&, int) { throw Error("this program was built without Embree", 1); }
struct EmbreeScene::Built {};
EmbreeScene::EmbreeScene(const EmbreeDevice&, EmbreeQuality) {
    throw Error("this program was built without Embree", 1);
}
EmbreeScene::~EmbreeScene() = default;
std::int64_t EmbreeScene::memory_bytes() const { return 0; }
Tracer EmbreeScene::closest(std::span<const Ray>, int, bool) const { return {}; }
Tracer EmbreeScene::occluded(std::span<const Ray>) const { return {}; }

#endif

} // namespace duet::compare
