#include "compare/peers/embree.h"

#include "common/system/error.h"
#include "compare/peers/embree_queries.h"

#include <atomic>

namespace duet::compare {

std::string name_of(EmbreeQuality quality) {
    return std::string(quality.high ? "high" : "medium") + (quality.robust ? "-robust" : "") +
           (quality.avx2 ? "-avx2" : "");
}

#if defined(DUET_EMBREE)

std::string embree_version() {
    return message("embree ", RTC_VERSION_MAJOR, '.', RTC_VERSION_MINOR, '.', RTC_VERSION_PATCH);
}

struct EmbreeDevice::Handle {
    RTCDevice device = nullptr;
    std::atomic<std::int64_t> bytes{0};
    std::vector<std::vector<Vec3>> positions; // per shape
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

} // namespace

EmbreeDevice::EmbreeDevice(const Scene& scene, int threads, bool avx2) : handle_(std::make_shared<Handle>()) {
    // The option simd512 uses AVX-512 wherever the CPU has it, even where Embree expects a reduced clock frequency.
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
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        handle_->positions.push_back(std::get<Mesh>(scene.shapes[i]).positions);
        handle_->positions.back().emplace_back(); // padding: Embree reads a vertex as 16 bytes
    }
}

struct EmbreeScene::BuiltScene {
    std::shared_ptr<EmbreeDevice::Handle> device;
    RTCScene scene = nullptr;
    std::vector<RTCScene> of_shapes; // one per shape, null if it is not instanced
    std::int64_t bytes = 0;

    BuiltScene(const std::shared_ptr<EmbreeDevice::Handle>& of, EmbreeQuality quality);
    ~BuiltScene() {
        for (RTCScene shape : of_shapes)
            if (shape != nullptr) rtcReleaseScene(shape);
        rtcReleaseScene(scene);
    }
    BuiltScene(const BuiltScene&) = delete;
    BuiltScene& operator=(const BuiltScene&) = delete;

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

EmbreeScene::BuiltScene::BuiltScene(const std::shared_ptr<EmbreeDevice::Handle>& of, EmbreeQuality quality)
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
    : built_(std::make_unique<BuiltScene>(device.handle(), quality)) {}

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
    return {"", [scene, rays, coherent](std::size_t block, RayResult* ray_results) {
                const FlushToZero flush;
                Query query(coherent);
                for (const Ray& ray : block_of(rays, block)) {
                    RTCRayHit hit = to_embree_ray_hit(ray);
                    intersect1(scene, query, hit);
                    *ray_results++ = to_ray_result(hit.ray.tfar, hit.hit.geomID, hit.hit.instID[0], hit.hit.primID);
                }
            }};
}

Tracer EmbreeScene::occluded(std::span<const Ray> rays) const {
    RTCScene scene = built_->scene;
    return {"", [scene, rays](std::size_t block, RayResult* ray_results) {
                const FlushToZero flush;
                Query query(false);
                for (const Ray& ray : block_of(rays, block)) {
                    RTCRay query_ray = to_embree_ray(ray);
                    occluded1(scene, query, query_ray);
                    *ray_results++ = {ray.t_max, query_ray.tfar < 0 ? 0 : RayResult::kNone}; // blocked: tfar = −∞
                }
            }};
}

#else

// These stubs replace Embree in a build without it. Version and qualities are empty, so that callers skip the rest.
std::string embree_version() { return {}; }
struct EmbreeDevice::Handle {};
std::vector<EmbreeQuality> embree_qualities() { return {}; }
EmbreeDevice::EmbreeDevice(const Scene&, int, bool) { throw Error("this program was built without Embree", 1); }
struct EmbreeScene::BuiltScene {};
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
