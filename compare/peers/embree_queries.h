// This file converts rays to Embree's forms (single, packets, streams), and provides one interface to the calls of
// Embree 3 and 4. Only embree.cpp includes it. It is empty if Embree is not installed.
#pragma once

#include "compare/kernels/tracer.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#if defined(DUET_EMBREE)

#if DUET_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace duet::compare {

/// Flushes denormals to zero in the current thread during the object's lifetime.
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

/// Holds the parameters of a query besides its rays: the context in Embree 3, the arguments in Embree 4.
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
inline void occluded1(RTCScene scene, Query& query, RTCRay& ray) { rtcOccluded1(scene, &ray, &query.any); }
inline void intersect1(RTCScene scene, Query& query, RTCRayHit& ray) { rtcIntersect1(scene, &ray, &query.closest); }
inline void intersect(const int* valid, RTCScene scene, Query& query, RTCRayHit8& rays) {
    rtcIntersect8(valid, scene, &rays, &query.closest);
}
inline void intersect(const int* valid, RTCScene scene, Query& query, RTCRayHit16& rays) {
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
inline void occluded1(RTCScene scene, Query& query, RTCRay& ray) { rtcOccluded1(scene, &query.context, &ray); }
inline void intersect1(RTCScene scene, Query& query, RTCRayHit& ray) { rtcIntersect1(scene, &query.context, &ray); }
inline void intersect(const int* valid, RTCScene scene, Query& query, RTCRayHit8& rays) {
    rtcIntersect8(valid, scene, &query.context, &rays);
}
inline void intersect(const int* valid, RTCScene scene, Query& query, RTCRayHit16& rays) {
    rtcIntersect16(valid, scene, &query.context, &rays);
}
inline void intersect_stream(RTCScene scene, Query& query, std::span<RTCRayHit> rays) {
    rtcIntersect1M(scene, &query.context, rays.data(), static_cast<unsigned>(rays.size()), sizeof(RTCRayHit));
}
#endif

/// Converts a result. Embree returns the ID of the geometry and, if there is one, of the instance. Both IDs are the
/// object's index.
inline RayResult to_ray_result(float t, unsigned geometry, unsigned instance, unsigned triangle) {
    if (geometry == RTC_INVALID_GEOMETRY_ID) return {};
    return {t, triangle, instance == RTC_INVALID_GEOMETRY_ID ? geometry : instance};
}

/// Returns the ray's start for Embree, whose interval includes t = tnear, while Duet's excludes t_min. The difference
/// matters for rays that start at t = 0 on a surface.
inline float embree_t_near(const Ray& ray) { return std::max(ray.t_min, std::numeric_limits<float>::min()); }

inline RTCRay to_embree_ray(const Ray& ray) {
    return {ray.origin.x,
            ray.origin.y,
            ray.origin.z,
            embree_t_near(ray),
            ray.direction.x,
            ray.direction.y,
            ray.direction.z,
            0,
            ray.t_max,
            0xffffffffu,
            0,
            0};
}

/// Holds the rays of a packet as a structure of arrays, ready to be copied.
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
        const Ray& ray = rays[std::min(i, rays.size() - 1)]; // lanes beyond the end are masked off
        packet.org_x[lane] = ray.origin.x, packet.org_y[lane] = ray.origin.y, packet.org_z[lane] = ray.origin.z;
        packet.dir_x[lane] = ray.direction.x, packet.dir_y[lane] = ray.direction.y;
        packet.dir_z[lane] = ray.direction.z;
        packet.tnear[lane] = embree_t_near(ray), packet.tfar[lane] = ray.t_max;
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
                   RayResult* ray_results) {
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
            *ray_results++ = to_ray_result(rays.ray.tfar[lane], rays.hit.geomID[lane], rays.hit.instID[0][lane],
                                           rays.hit.primID[lane]);
    }
}

template <int kWidth, typename RayHit>
std::function<void(std::size_t, RayResult*)> packet_function(RTCScene scene, std::span<const Ray> rays, bool coherent) {
    const auto packets = std::make_shared<const std::vector<PacketRays<kWidth>>>(packets_of<kWidth>(rays));
    return [scene, packets, coherent](std::size_t block, RayResult* ray_results) {
        const FlushToZero flush;
        Query query(coherent);
        trace_packets<kWidth, RayHit>(scene, query, *packets, block, ray_results);
    };
}

inline RTCRayHit to_embree_ray_hit(const Ray& ray) {
    RTCRayHit hit;
    hit.ray = to_embree_ray(ray);
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return hit;
}

#if DUET_EMBREE == 3
/// Returns a function that traces a block's rays as an array of structures (rtcIntersect1M).
inline std::function<void(std::size_t, RayResult*)> stream_of_structures(RTCScene scene, std::span<const Ray> rays,
                                                                         bool coherent) {
    const auto laid_out = std::make_shared<std::vector<RTCRayHit>>();
    for (const Ray& ray : rays) laid_out->push_back(to_embree_ray_hit(ray));
    return [scene, laid_out, coherent](std::size_t block, RayResult* ray_results) {
        const FlushToZero flush;
        Query query(coherent);
        const std::size_t first = block * kBlock, count = std::min(kBlock, laid_out->size() - first);
        alignas(64) std::array<RTCRayHit, kBlock> stream;
        std::memcpy(stream.data(), laid_out->data() + first, count * sizeof(RTCRayHit));
        intersect_stream(scene, query, std::span(stream).first(count));
        for (std::size_t i = 0; i < count; ++i) {
            const RTCRayHit& hit = stream[i];
            *ray_results++ = to_ray_result(hit.ray.tfar, hit.hit.geomID, hit.hit.instID[0], hit.hit.primID);
        }
    };
}

/// Holds the rays and hits of a block as a structure of arrays.
struct alignas(64) StreamArrays {
    using Floats = std::array<float, kBlock>;
    using Numbers = std::array<unsigned, kBlock>;
    Floats org_x, org_y, org_z, tnear, dir_x, dir_y, dir_z, tfar, time, ng_x, ng_y, ng_z, u, v;
    Numbers mask, id, flags, prim, geom, instance;

    RTCRayHitNp pointers() {
        RTCRayHitNp p;
        p.ray = {org_x.data(), org_y.data(), org_z.data(), tnear.data(), dir_x.data(), dir_y.data(),
                 dir_z.data(), time.data(),  tfar.data(),  mask.data(),  id.data(),    flags.data()};
        p.hit = {ng_x.data(), ng_y.data(), ng_z.data(), u.data(),
                 v.data(),    prim.data(), geom.data(), {instance.data()}};
        return p;
    }
};

inline std::function<void(std::size_t, RayResult*)> stream_of_arrays(RTCScene scene, std::span<const Ray> rays,
                                                                     bool coherent) {
    const auto laid_out = std::make_shared<std::vector<PacketRays<kBlock>>>(packets_of<kBlock>(rays));
    const std::size_t size = rays.size();
    return [scene, laid_out, size, coherent](std::size_t block, RayResult* ray_results) {
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
            *ray_results++ = to_ray_result(stream.tfar[i], stream.geom[i], stream.instance[i], stream.prim[i]);
    };
}
#endif

} // namespace duet::compare

#endif
