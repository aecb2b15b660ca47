#include "compare/frames/llvmpipe.h"

#include "common/system/error.h"
#include "compare/frames/gl.h"
#include "compare/metrics/image_metrics.h"
#include "raster/shading/phong_model.h"

#include <array>
#include <vector>

namespace duet::compare {

#if defined(DUET_LLVMPIPE)

namespace {

constexpr const char* kVertexShader = R"(#version 450 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 to_clip;
out vec3 p, n;
void main() {
    p = position;
    n = normal;
    gl_Position = to_clip * vec4(position, 1);
}
)";

/// This shader is raster/shading/phong_model.h in GLSL.
constexpr const char* kFragmentShader = R"(#version 450 core
in vec3 p, n;
uniform vec3 eye, to_sun, diffuse, sun, ambient;
out vec4 color;
void main() {
    vec3 normal = normalize(n), to_viewer = normalize(eye - p);
    float cosine = dot(normal, to_sun);
    float s = max(dot(reflect(-to_sun, normal), to_viewer), 0.0);
    s *= s; s *= s; s *= s; s *= s; s *= s;
    vec3 light = cosine > 0.0 ? sun * cosine * (diffuse * DIFFUSE + vec3(SPECULAR * s)) : vec3(0);
    color = vec4(ambient * diffuse + light, 1);
}
)";
constexpr const char* kDepthShader = "#version 450 core\nvoid main() {}\n";

std::string replaced(std::string text, const std::string& name, float value) {
    text.replace(text.find(name), name.size(), std::to_string(value));
    return text;
}

struct Vertex {
    Vec3 p, n;
};

/// Returns the projection matrix. Pixel (0, 0) comes first in the buffer, and depth is near/depth: reversed,
/// without a far plane, as in the rasterizer.
std::array<float, 16> clip_matrix(const View& view) {
    const Pinhole pinhole = CameraModel(view).pinhole();
    const Mat4d& m = pinhole.world_to_pixel;
    std::array<float, 16> columns{};
    for (std::size_t c = 0; c < 4; ++c) {
        columns[4 * c] = static_cast<float>(2 * m[0][c] / view.width - m[3][c]);
        columns[4 * c + 1] = static_cast<float>(2 * m[1][c] / view.height - m[3][c]);
        columns[4 * c + 2] = c == 3 ? static_cast<float>(pinhole.near) : 0.0f;
        columns[4 * c + 3] = static_cast<float>(m[3][c]);
    }
    return columns;
}

} // namespace

struct LlvmpipeRenderer::State {
    GlContext gl;
    View view;
    GLsizei indices = 0;
    GLuint phong = 0, depth = 0;

    State(const Scene& scene, const View& requested_view, int threads) : gl(threads), view(requested_view) {
        upload(std::get<Mesh>(scene.shapes.front()));
        make_target();
        phong = program(replaced(replaced(kFragmentShader, "DIFFUSE", raster::kPhongDiffuse), "SPECULAR",
                                 raster::kPhongSpecular));
        depth = program(kDepthShader);
        set_light(scene);
        gl.Enable(GL_CULL_FACE);
        gl.FrontFace(GL_CW); // rows run downwards, so to OpenGL the image is mirrored
        gl.Enable(GL_DEPTH_TEST);
        gl.DepthFunc(GL_GREATER);
        gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
        gl.ClearDepth(0);
        gl.Enable(GL_FRAMEBUFFER_SRGB);
        gl.Viewport(0, 0, view.width, view.height);
        gl.check("setting up");
    }

    void upload(const Mesh& mesh) {
        std::vector<Vertex> vertices(mesh.positions.size());
        for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] = {mesh.positions[i], mesh.normals.at(i)};
        GLuint array = 0;
        std::array<GLuint, 2> buffers{};
        gl.GenVertexArrays(1, &array);
        gl.BindVertexArray(array);
        gl.GenBuffers(2, buffers.data());
        const auto bytes = [](const auto& v) { return static_cast<GLsizeiptr>(v.size() * sizeof(v[0])); };
        gl.BindBuffer(GL_ARRAY_BUFFER, buffers[0]);
        gl.BufferData(GL_ARRAY_BUFFER, bytes(vertices), vertices.data(), GL_STATIC_DRAW);
        gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
        gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, bytes(mesh.triangles), mesh.triangles.data(), GL_STATIC_DRAW);
        for (const GLuint attribute : {0u, 1u}) {
            gl.VertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                                   reinterpret_cast<const void*>(attribute * sizeof(Vec3)));
            gl.EnableVertexAttribArray(attribute);
        }
        indices = static_cast<GLsizei>(3 * mesh.triangles.size());
    }

    void make_target() {
        GLuint frame = 0;
        std::array<GLuint, 2> buffers{};
        gl.GenFramebuffers(1, &frame);
        gl.BindFramebuffer(GL_FRAMEBUFFER, frame);
        gl.GenRenderbuffers(2, buffers.data());
        const auto attach = [&](GLuint buffer, GLenum format, GLenum point) {
            gl.BindRenderbuffer(GL_RENDERBUFFER, buffer);
            gl.RenderbufferStorage(GL_RENDERBUFFER, format, view.width, view.height);
            gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, point, GL_RENDERBUFFER, buffer);
        };
        attach(buffers[0], GL_SRGB8_ALPHA8, GL_COLOR_ATTACHMENT0);
        attach(buffers[1], GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT);
        if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
            throw Error("llvmpipe: the frame buffer is incomplete");
    }

    GLuint program(const std::string& fragment_source) {
        const GLuint result = gl.CreateProgram();
        const auto add = [&](GLenum kind, const std::string& source) {
            const GLuint shader = gl.CreateShader(kind);
            const char* text = source.c_str();
            gl.ShaderSource(shader, 1, &text, nullptr);
            gl.CompileShader(shader);
            gl.AttachShader(result, shader);
        };
        add(GL_VERTEX_SHADER, kVertexShader);
        add(GL_FRAGMENT_SHADER, fragment_source);
        gl.LinkProgram(result);
        GLint linked = 0;
        gl.GetProgramiv(result, GL_LINK_STATUS, &linked);
        if (!linked) {
            std::array<char, 1000> log{};
            gl.GetProgramInfoLog(result, static_cast<GLsizei>(log.size()), nullptr, log.data());
            throw Error(message("llvmpipe: a shader is refused: ", log.data()));
        }
        gl.UseProgram(result);
        gl.UniformMatrix4fv(gl.GetUniformLocation(result, "to_clip"), 1, GL_FALSE, clip_matrix(view).data());
        return result;
    }

    void set_light(const Scene& scene) {
        const auto& sun = std::get<SunLight>(scene.lights.at(0));
        const Rgb diffuse = std::get<Diffuse>(scene.materials.at(0)).albedo.value;
        gl.UseProgram(phong);
        const auto set = [&](const char* uniform, float x, float y, float z) {
            gl.Uniform3f(gl.GetUniformLocation(phong, uniform), x, y, z);
        };
        const Vec3 eye(view.camera.eye), to_sun = -sun.direction;
        const Rgb ambient = mean_radiance(scene.environment);
        set("eye", eye.x, eye.y, eye.z);
        set("to_sun", to_sun.x, to_sun.y, to_sun.z);
        set("diffuse", diffuse.r, diffuse.g, diffuse.b);
        set("sun", sun.irradiance.r, sun.irradiance.g, sun.irradiance.b);
        set("ambient", ambient.r, ambient.g, ambient.b);
    }
};

bool LlvmpipeRenderer::built() { return true; }

LlvmpipeRenderer::LlvmpipeRenderer(const Scene& scene, const View& view, int threads)
    : state_(std::make_unique<State>(scene, view, threads)) {}
LlvmpipeRenderer::~LlvmpipeRenderer() = default;

std::string LlvmpipeRenderer::name() const {
    const auto text = [&](GLenum what) { return reinterpret_cast<const char*>(state_->gl.GetString(what)); };
    return message(text(GL_RENDERER), ", ", text(GL_VERSION));
}

void LlvmpipeRenderer::draw(FrameWork work) {
    const GlContext& gl = state_->gl;
    const GLboolean colors = work == FrameWork::kPhong ? GL_TRUE : GL_FALSE;
    gl.UseProgram(colors ? state_->phong : state_->depth);
    gl.ColorMask(colors, colors, colors, colors);
    gl.Clear(static_cast<GLbitfield>(colors ? GL_COLOR_BUFFER_BIT : 0) | GL_DEPTH_BUFFER_BIT);
    gl.DrawElements(GL_TRIANGLES, state_->indices, GL_UNSIGNED_INT, nullptr);
    gl.Finish();
}

ImageRgb LlvmpipeRenderer::image() const {
    const View& view = state_->view;
    Image<Rgba8> bytes(view.width, view.height);
    state_->gl.ReadPixels(0, 0, view.width, view.height, GL_RGBA, GL_UNSIGNED_BYTE, &bytes[0]);
    state_->gl.check("reading the image");
    return encoded_values(bytes);
}

ImageFloat LlvmpipeRenderer::reversed_depth() const {
    const View& view = state_->view;
    ImageFloat result(view.width, view.height);
    state_->gl.ReadPixels(0, 0, view.width, view.height, GL_DEPTH_COMPONENT, GL_FLOAT, &result[0]);
    state_->gl.check("reading the depths");
    return result;
}

#else // a build without EGL or OpenGL headers has no peer

struct LlvmpipeRenderer::State {};

bool LlvmpipeRenderer::built() { return false; }
LlvmpipeRenderer::LlvmpipeRenderer(const Scene&, const View&, int) {
    throw Error("llvmpipe: this program was built without EGL");
}
LlvmpipeRenderer::~LlvmpipeRenderer() = default;
std::string LlvmpipeRenderer::name() const { return {}; }
void LlvmpipeRenderer::draw(FrameWork) {}
ImageRgb LlvmpipeRenderer::image() const { return {}; }
ImageFloat LlvmpipeRenderer::reversed_depth() const { return {}; }

#endif

} // namespace duet::compare
