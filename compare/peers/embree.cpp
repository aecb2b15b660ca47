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
    return std::string(quality.high ? "high" : "medium") + (quality.robust ? "-robust" : "") + (quality.avx2 ? "-avx2" : "");
}

#if defined(DUET_EMBREE)

std::string embree_version() {
    return message("embree ", RTC_VERSION_MAJOR, '.', RTC_VERSION_MINOR, '.', RTC_VERSION_PATCH);
}

struct EmbreeDevice::Handle {
    RTCDevice device = nullptr;
    std::atomic<std::int64_t> bytes{0};
    std::vector<std::vector<Vec3>> positions; // of each shape
    const Scene* scene = nullptr;

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
void intersect_stream(RTCScene scene, Query& query, std::span<RTCRayHit> rays) {
    rtcIntersect1M(scene, &query.context, rays.data(), static_cast<unsigned>(rays.size()), sizeof(RTCRayHit));
}
#endif

/// Embree names the instance, where there is one, and the geometry: both by the object's number.
Answer answer_of(float t, unsigned geometry, unsigned instance, unsigned triangle) {
    if (geometry == RTC_INVALID_GEOMETRY_ID) return {};
    return {t, triangle, instance == RTC_INVALID_GEOMETRY_ID ? geometry : instance};
}

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
    for (std::size_t p = block * kPackets; p < std::min(packets.size(), (block + 1) * kPackets); ++p) {
        load<kWidth>(packets[p], rays.ray);
        std::memset(rays.hit.geomID, 0xff, sizeof rays.hit.geomID); // RTC_INVALID_GEOMETRY_ID
        std::memset(rays.hit.instID, 0xff, sizeof rays.hit.instID);
        intersect(packets[p].valid, scene, query, rays);
        for (std::size_t lane = 0; lane < kWidth; ++lane)
            *answers++ = answer_of(rays.ray.tfar[lane], rays.hit.geomID[lane], rays.hit.instID[0][lane],
                                   rays.hit.primID[lane]);
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

RTCRayHit as_embree_hit(const Ray& ray) {
    RTCRayHit hit;
    hit.ray = as_embree(ray);
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return hit;
}

#if DUET_EMBREE == 3
/// A block's rays as a stream of structures.
std::function<void(std::size_t, Answer*)> stream_of_structures(RTCScene scene, std::span<const Ray> rays,
                                                               bool coherent) {
    const auto laid_out = std::make_shared<std::vector<RTCRayHit>>();
    for (const Ray& ray : rays) laid_out->push_back(as_embree_hit(ray));
    return [scene, laid_out, coherent](std::size_t block, Answer* answers) {
        const FlushToZero flush;
        Query query(coherent);
        const std::size_t first = block * kBlock, count = std::min(kBlock, laid_out->size() - first);
        alignas(64) std::array<RTCRayHit, kBlock> stream;
        std::memcpy(stream.data(), laid_out->data() + first, count * sizeof(RTCRayHit));
        intersect_stream(scene, query, std::span(stream).first(count));
        for (std::size_t i = 0; i < count; ++i) {
            const RTCRayHit& hit = stream[i];
            *answers++ = answer_of(hit.ray.tfar, hit.hit.geomID, hit.hit.instID[0], hit.hit.primID);
        }
    };
}

/// A block's rays and hits as arrays of one quantity each.
struct alignas(64) StreamArrays {
    using Floats = std::array<float, kBlock>;
    using Numbers = std::array<unsigned, kBlock>;
    Floats org_x, org_y, org_z, tnear, dir_x, dir_y, dir_z, tfar, time, ng_x, ng_y, ng_z, u, v;
    Numbers mask, id, flags, prim, geom, instance;

    RTCRayHitNp pointers() {
        RTCRayHitNp p;
        p.ray = {org_x.data(), org_y.data(), org_z.data(), tnear.data(), dir_x.data(), dir_y.data(),
                 dir_z.data(), time.data(),  tfar.data(),  mask.data(),  id.data(),    flags.data()};
        p.hit = {ng_x.data(), ng_y.data(), ng_z.data(), u.data(), v.data(), prim.data(), geom.data(), {instance.data()}};
        return p;
    }
};

std::function<void(std::size_t, Answer*)> stream_of_arrays(RTCScene scene, std::span<const Ray> rays, bool coherent) {
    const auto laid_out = std::make_shared<std::vector<PacketRays<kBlock>>>(packets_of<kBlock>(rays));
    const std::size_t size = rays.size();
    return [scene, laid_out, size, coherent](std::size_t block, Answer* answers) {
        const FlushToZero flush;
        Query query(coherent);
        const PacketRays<kBlock>& from = (*laid_out)[block];
        const auto count = static_cast<unsigned>(std::min(kBlock, size - block * kBlock));
        StreamArrays stream;
        const auto copy = [](auto& to, const auto& lanes) { std::memcpy(to.data(), lanes, sizeof to); };
        copy(stream.org_x, from.org_x), copy(stream.org_y, from.org_y), copy(stream.org_z, from.org_z);
        copy(stream.dir_x, from.dir_x), copy(stream.dir_y, from.dir_y), copy(stream.dir_z, from.dir_z);
        copy(stream.tnear, from.tnear), copy(stream.tfar, from.tfar);
        stream.time.fill(0);
        stream.mask.fill(~0u);
        stream.flags.fill(0);
        stream.geom.fill(RTC_INVALID_GEOMETRY_ID);
        stream.instance.fill(RTC_INVALID_GEOMETRY_ID);
        const RTCRayHitNp pointers = stream.pointers();
        rtcIntersectNp(scene, &query.context, &pointers, count);
        for (std::size_t i = 0; i < count; ++i)
            *answers++ = answer_of(stream.tfar[i], stream.geom[i], stream.instance[i], stream.prim[i]);
    };
}
#endif

} // namespace

EmbreeDevice::EmbreeDevice(const Scene& scene, int threads, bool avx2) : handle_(std::make_shared<Handle>()) {
    // simd512: AVX-512 wherever the processor has it, whatever clock frequency Embree thinks it costs there.
    const char* const instructions = avx2 ? "isa=avx2" : "frequency_level=simd512";
    handle_->device = rtcNewDevice(message("threads=", threads, ",", instructions).c_str());
    fail_on_error(handle_->device);
    rtcSetDeviceMemoryMonitorFunction(
        handle_->device,
        [](void* handle, ssize_t bytes, bool) {
            static_cast<Handle*>(handle)->bytes += bytes;
            return true;
        },
        handle_.get());
    handle_->scene = &scene;
    for (const Shape& shape : scene.shapes) {
        handle_->positions.push_back(std::get<Mesh>(shape).positions);
        handle_->positions.back().emplace_back(); // a vertex is read as 16 bytes
    }
}

struct EmbreeScene::Built {
    std::shared_ptr<EmbreeDevice::Handle> device;
    RTCScene scene = nullptr;
    std::vector<RTCScene> of_shapes; // of those that instances show
    std::int64_t bytes = 0;

    Built(const std::shared_ptr<EmbreeDevice::Handle>& of, EmbreeQuality quality);
    ~Built() {
        for (RTCScene shape : of_shapes)
            if (shape != nullptr) rtcReleaseScene(shape);
        rtcReleaseScene(scene);
    }
    Built(const Built&) = delete;
    Built& operator=(const Built&) = delete;

private:
    RTCScene new_scene() const {
        RTCScene made = rtcNewScene(device->device);
        rtcSetSceneBuildQuality(made, build_quality);
        rtcSetSceneFlags(made, flags);
        return made;
    }
    void attach(RTCScene to, RTCGeometry geometry, std::uint32_t number) const {
        rtcSetGeometryBuildQuality(geometry, build_quality);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(to, geometry, number);
        rtcReleaseGeometry(geometry);
    }
    void attach_triangles(RTCScene to, std::uint32_t shape, std::uint32_t number) const {
        RTCGeometry geometry = rtcNewGeometry(device->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        const auto& positions = device->positions[shape];
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions.data(), 0,
                                   sizeof(Vec3), positions.size() - 1);
        const auto& triangles = std::get<Mesh>(device->scene->shapes[shape]).triangles;
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0,
                                   sizeof triangles[0], triangles.size());
        attach(to, geometry, number);
    }
    void attach_instance(const Object& object, std::uint32_t number) {
        RTCScene& shown = of_shapes[object.shape];
        if (shown == nullptr) {
            shown = new_scene();
            attach_triangles(shown, object.shape, 0);
            rtcCommitScene(shown);
        }
        RTCGeometry geometry = rtcNewGeometry(device->device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(geometry, shown);
        rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, object.to_world.m.data());
        attach(scene, geometry, number);
    }

    RTCBuildQuality build_quality;
    RTCSceneFlags flags;
};

EmbreeScene::Built::Built(const std::shared_ptr<EmbreeDevice::Handle>& of, EmbreeQuality quality)
    : device(of), of_shapes(of->scene->shapes.size()),
      build_quality(quality.high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM),
      flags(quality.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE) {
    const std::int64_t before = device->bytes;
    scene = new_scene();
    const std::vector<Object>& objects = device->scene->objects;
    for (std::uint32_t i = 0; i < objects.size(); ++i) {
        if (objects[i].identity)
            attach_triangles(scene, objects[i].shape, i);
        else
            attach_instance(objects[i], i);
    }
    rtcCommitScene(scene);
    fail_on_error(device->device);
    bytes = device->bytes - before;
}

EmbreeScene::EmbreeScene(const EmbreeDevice& device, EmbreeQuality quality)
    : built_(std::make_unique<Built>(device.handle(), quality)) {}

EmbreeScene::~EmbreeScene() = default;

std::int64_t EmbreeScene::memory_bytes() const { return built_->bytes; }

std::vector<EmbreeQuality> embree_qualities() {
    std::vector<EmbreeQuality> all{{false, false}, {true, false}, {false, true}, {true, true}};
    RTCDevice device = rtcNewDevice("threads=1");
    const bool avx512 = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
    rtcReleaseDevice(device);
    if (avx512) all.insert(all.end(), {{false, false, true}, {true, false, true}});
    return all;
}

std::vector<EmbreeForm> embree_bulk_forms() {
#if DUET_EMBREE == 3
    return {EmbreeForm::kPackets16, EmbreeForm::kPackets8, EmbreeForm::kStreamM, EmbreeForm::kStreamNp};
#else
    return {EmbreeForm::kPackets16, EmbreeForm::kPackets8};
#endif
}

Tracer EmbreeScene::closest(std::span<const Ray> rays, EmbreeForm form, bool coherent) const {
    RTCScene scene = built_->scene;
    switch (form) {
    case EmbreeForm::kPackets16:
        return {"packets 16", packet_function<16, RTCRayHit16>(scene, rays, coherent)};
    case EmbreeForm::kPackets8:
        return {"packets 8", packet_function<8, RTCRayHit8>(scene, rays, coherent)};
#if DUET_EMBREE == 3
    case EmbreeForm::kStreamM:
        return {"stream M", stream_of_structures(scene, rays, coherent)};
    case EmbreeForm::kStreamNp:
        return {"stream Np", stream_of_arrays(scene, rays, coherent)};
#endif
    default:
        break;
    }
    DUET_CHECK(form == EmbreeForm::kSingle);
    return {"", [scene, rays, coherent](std::size_t block, Answer* answers) {
                const FlushToZero flush;
                Query query(coherent);
                for (const Ray& ray : block_of(rays, block)) {
                    RTCRayHit hit = as_embree_hit(ray);
                    intersect1(scene, query, hit);
                    *answers++ = answer_of(hit.ray.tfar, hit.hit.geomID, hit.hit.instID[0], hit.hit.primID);
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
std::vector<EmbreeQuality> embree_qualities() { return {}; }
EmbreeDevice::EmbreeDevice(const Scene&, int, bool) { throw Error("this program was built without Embree", 1); }
struct EmbreeScene::Built {};
EmbreeScene::EmbreeScene(const EmbreeDevice&, EmbreeQuality) {
    throw Error("this program was built without Embree", 1);
}
EmbreeScene::~EmbreeScene() = default;
std::int64_t EmbreeScene::memory_bytes() const { return 0; }
std::vector<EmbreeForm> embree_bulk_forms() { return {}; }
Tracer EmbreeScene::closest(std::span<const Ray>, EmbreeForm, bool) const { return {}; }
Tracer EmbreeScene::occluded(std::span<const Ray>) const { return {}; }

#endif

} // namespace duet::compare
