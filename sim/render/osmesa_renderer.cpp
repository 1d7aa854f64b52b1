// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>
#include <numeric>
#include <string>

#include <fmt/format.h>

#include "sim/render/color.hpp"
#include "sim/render/osmesa_context.hpp"
#include "sim/render/renderer.hpp"
#include "sim/render/texture.hpp"
#include "slam/core/error.hpp"

namespace mh {

#ifdef MH_HAS_OSMESA
namespace {

using Eigen::Vector3f;

// Nearer surfaces are cut away; a ray tracer sees them.
constexpr float kNearM = 1e-3F;

// The camera's frame is x right, y down, z forward; row 0 of a picture is the first that is read
// back, so nothing is turned over. Depth is reversed (near / z), which is finest in floats.
constexpr const char* kVertexShader = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec3 gain;
uniform vec3 origin;
uniform mat3 camera_from_world;
uniform mat4 clip_from_camera;
out vec2 texture_place;
out vec3 vertex_gain;
out vec3 from_origin;
void main() {
  from_origin = position - origin;
  texture_place = uv;
  vertex_gain = gain;
  gl_Position = clip_from_camera * vec4(camera_from_world * from_origin, 1.0);
}
)";

// The level of detail follows TextureTable::look_up: the texels that a pixel covers.
// Holes follow CutOuts::is_hole. Only a scene that has any pays for them: a shader that may discard
// is tested for depth after it has run.
constexpr const char* kVersion = "#version 450 core\n";
constexpr const char* kVersionWithHoles = "#version 450 core\n#define HOLES\n";
constexpr const char* kFragmentShader = R"(
in vec2 texture_place;
in vec3 vertex_gain;
in vec3 from_origin;
uniform sampler2D picture;
uniform samplerBuffer normals;   // per face: normal x twice its area, texels of twice its area
uniform usamplerBuffer labels;   // per face: class, instance
uniform int first_face;
uniform bool textured;
uniform bool has_holes;
uniform sampler2D opacity;
uniform vec3 base;
uniform vec3 emission;
uniform float white;  // what is brighter is cut off
uniform float pixel_area;
uniform float least_opacity;
layout(location = 0) out vec4 color;
layout(location = 1) out uvec2 label;
layout(location = 2) out float depth;
void main() {
#ifdef HOLES
  if (has_holes) {
    ivec2 size = textureSize(opacity, 0);
    ivec2 texel = min(size - 1, ivec2((texture_place - floor(texture_place)) * vec2(size)));
    if (texelFetch(opacity, texel, 0).r < least_opacity) discard;
  }
#endif
  int face = first_face + gl_PrimitiveID;
  depth = 1.0 / gl_FragCoord.w;
  vec3 light = vertex_gain * base;
  if (textured) {
    vec4 normal = texelFetch(normals, face);
    float facing = abs(dot(normal.xyz, from_origin / depth));
    float texels = depth * depth * pixel_area * normal.w / facing;
    float level = 0.5 * (float(floatBitsToInt(texels)) * exp2(-23.0) - 127.0);
    light *= textureLod(picture, texture_place, clamp(level, 0.0, 15.0)).rgb;
  }
  color = vec4(clamp(light + emission, 0.0, white), 1.0);
  label = texelFetch(labels, face).xy;
}
)";

/// The faces of one material, drawn at once.
struct Batch {
  int first = 0, count = 0;  // faces
  GLuint texture = 0;        // 0 = none
  GLuint opacity = 0;        // 0 = no holes
  Vector3f base, emission;   // linear, x exposure
  bool pane = false;         // emission is what the pane lets through
};

class OsmesaRenderer final : public Renderer {
 public:
  OsmesaRenderer(const Scene& scene, const RenderConfig& config)
      : gl_(context_.gl()), exposure_(scene.light.empty() ? 0.0F : config.exposure) {
    const OffscreenContext::Current current(context_);
    has_panes_ = std::ranges::any_of(scene.materials, &Material::is_pane);
    make_program(
        std::ranges::any_of(scene.materials, [](const Material& m) { return !m.opacity.empty(); }));
    const std::vector<std::uint32_t> order = sort_faces(scene);
    make_batches(scene, order, config.exposure);
    load_vertices(scene);
    load_faces(scene, order);
    Vector3f sky = Vector3f::Zero();
    for (const Light& light : scene.lights)
      if (light.kind == Light::Kind::kSky) sky += light.color * config.exposure;
    for (int k = 0; k < 3; ++k) sky_[static_cast<std::size_t>(k)] = std::min(sky[k], white());
    check("load the scene");
  }

  RenderedFrame render(const Camera& camera, const SE3& world_from_camera) const override {
    check_projection(camera);
    const std::lock_guard lock(mutex_);
    const OffscreenContext::Current current(context_);
    prepare_targets(camera.width_px, camera.height_px);
    set_view(camera, world_from_camera);
    constexpr std::array<GLuint, 4> kNoLabel = {};
    constexpr std::array<float, 4> kNoDepth = {};
    gl_.ClearBufferfv(GL_COLOR, 0, sky_.data());
    gl_.ClearBufferuiv(GL_COLOR, 1, kNoLabel.data());
    gl_.ClearBufferfv(GL_COLOR, 2, kNoDepth.data());
    gl_.ClearBufferfv(GL_DEPTH, 0, kNoDepth.data());
    for (const Batch& batch : batches_)
      if (!batch.pane) draw(batch);
    if (has_panes_) draw_panes();
    RenderedFrame frame = read_back(camera.width_px, camera.height_px);
    frame.exposure = exposure_;
    check("draw");
    return frame;
  }

 private:
  /// Behind a pane what is brighter than white need not be white.
  float white() const { return has_panes_ ? std::numeric_limits<float>::max() : 1.0F; }

  void check(const char* what) const {
    const GLenum error = gl_.GetError();
    if (error != GL_NO_ERROR)
      throw MachineError(fmt::format("OSMesa failed to {} (error {:#x})", what, error));
  }

  GLint place(const char* uniform) const { return gl_.GetUniformLocation(program_, uniform); }

  void make_program(bool with_holes) {
    program_ = gl_.CreateProgram();
    const auto add = [&](GLenum kind, const char* source) {
      const GLuint shader = gl_.CreateShader(kind);
      const std::array<const char*, 2> parts = {with_holes ? kVersionWithHoles : kVersion, source};
      gl_.ShaderSource(shader, 2, parts.data(), nullptr);
      gl_.CompileShader(shader);
      gl_.AttachShader(program_, shader);
    };
    add(GL_VERTEX_SHADER, kVertexShader);
    add(GL_FRAGMENT_SHADER, kFragmentShader);
    gl_.LinkProgram(program_);
    GLint linked = 0;
    gl_.GetProgramiv(program_, GL_LINK_STATUS, &linked);
    if (linked == 0) {
      std::array<char, 512> log{};
      gl_.GetProgramInfoLog(program_, static_cast<GLsizei>(log.size()) - 1, nullptr, log.data());
      throw MachineError(fmt::format("OSMesa refuses the shaders: {}", log.data()));
    }
    gl_.UseProgram(program_);
    gl_.Uniform1i(place("picture"), 0);
    gl_.Uniform1i(place("normals"), 1);
    gl_.Uniform1i(place("labels"), 2);
    gl_.Uniform1i(place("opacity"), 3);
    gl_.Uniform1f(place("white"), white());
    gl_.Uniform1f(place("least_opacity"), (static_cast<float>(kOpaqueFrom) - 0.5F) / 255.0F);
    gl_.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthFunc(GL_GREATER);
    gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  }

  /// Faces by material, else in their order.
  static std::vector<std::uint32_t> sort_faces(const Scene& scene) {
    std::vector<std::uint32_t> order(scene.triangles.size());
    std::iota(order.begin(), order.end(), 0U);
    if (!scene.materials.empty())
      std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return scene.material_of[a] < scene.material_of[b];
      });
    return order;
  }

  void make_batches(const Scene& scene, const std::vector<std::uint32_t>& order, float exposure) {
    if (scene.materials.empty()) {
      batches_.push_back({0, static_cast<int>(order.size()), 0, 0, Vector3f::Constant(exposure),
                          Vector3f::Zero()});
      return;
    }
    for (int first = 0; first < static_cast<int>(order.size());) {
      const std::uint16_t id = scene.material_of[order[static_cast<std::size_t>(first)]];
      int end = first;
      while (end < static_cast<int>(order.size()) &&
             scene.material_of[order[static_cast<std::size_t>(end)]] == id)
        ++end;
      const Material& material = scene.materials[id];
      Batch batch{first,
                  end - first,
                  0,
                  0,
                  srgb_to_linear(material.base_color) * exposure,
                  material.emission * exposure};
      if (!material.texture.empty()) {
        if (scene.uvs.empty())
          batch.base = batch.base.cwiseProduct(mean_linear(material.texture));
        else
          batch.texture = load_texture(material.texture);
      }
      if (!material.opacity.empty() && !scene.uvs.empty() && material.emission.isZero())
        batch.opacity = load_opacity(material.opacity);
      if (material.is_pane())
        batch = {.first = first,
                 .count = end - first,
                 .base = Vector3f::Zero(),
                 .emission = material.transmission,
                 .pane = true};
      batches_.push_back(batch);
      first = end;
    }
  }

  GLuint load_texture(const Grid2d<Rgb8>& picture) const {
    GLuint texture = 0;
    gl_.GenTextures(1, &texture);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, texture);
    const auto levels = mip_pyramid(picture);
    for (std::size_t l = 0; l < levels.size(); ++l) {
      std::vector<std::uint16_t> texels;
      for (const Vector3f& c : levels[l])
        for (int k = 0; k < 4; ++k)
          texels.push_back(static_cast<std::uint16_t>(std::lround((k < 3 ? c[k] : 1.0F) * 65535)));
      gl_.TexImage2D(GL_TEXTURE_2D, static_cast<GLint>(l), GL_RGBA16, levels[l].width(),
                     levels[l].height(), 0, GL_RGBA, GL_UNSIGNED_SHORT, texels.data());
    }
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, static_cast<GLint>(levels.size()) - 1);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    return texture;
  }

  GLuint load_opacity(const Grid2d<std::uint8_t>& opacity) const {
    GLuint texture = 0;
    gl_.GenTextures(1, &texture);
    gl_.ActiveTexture(GL_TEXTURE3);
    gl_.BindTexture(GL_TEXTURE_2D, texture);
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, opacity.width(), opacity.height(), 0, GL_RED,
                   GL_UNSIGNED_BYTE, opacity.data());
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_.ActiveTexture(GL_TEXTURE0);
    return texture;
  }

  template <class T>
  void fill(GLenum target, const std::vector<T>& data) const {
    GLuint buffer = 0;
    gl_.GenBuffers(1, &buffer);
    gl_.BindBuffer(target, buffer);
    gl_.BufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(),
                   GL_STATIC_DRAW);
  }

  void load_vertices(const Scene& scene) const {
    GLuint array = 0;
    gl_.GenVertexArrays(1, &array);
    gl_.BindVertexArray(array);
    const auto attribute = [&](GLuint index, GLint size, const auto& data) {
      fill(GL_ARRAY_BUFFER, data);
      gl_.EnableVertexAttribArray(index);
      gl_.VertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, 0, nullptr);
    };
    attribute(0, 3, scene.positions_m);
    if (!scene.uvs.empty()) attribute(1, 2, scene.uvs);
    std::vector<Vector3f> gain(scene.positions_m.size(), Vector3f::Ones());
    for (std::size_t v = 0; v < gain.size(); ++v) {
      if (!scene.colors.empty()) gain[v] = srgb_to_linear(scene.colors[v]);
      if (!scene.light.empty()) gain[v] = gain[v].cwiseProduct(scene.light[v]);
    }
    attribute(2, 3, gain);
  }

  void load_faces(const Scene& scene, const std::vector<std::uint32_t>& order) const {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::array<float, 4>> normals;
    std::vector<std::array<std::uint16_t, 2>> labels;
    for (const std::uint32_t f : order) {
      const auto& t = scene.triangles[f];
      triangles.push_back(t);
      const Vector3f &a = scene.positions_m[t[0]], &b = scene.positions_m[t[1]],
                     &c = scene.positions_m[t[2]];
      const Vector3f normal = (b - a).cross(c - a);
      float texels = 0.0F;
      if (!scene.uvs.empty() && !scene.materials.empty()) {
        const Eigen::Vector2f p = scene.uvs[t[1]] - scene.uvs[t[0]];
        const Eigen::Vector2f q = scene.uvs[t[2]] - scene.uvs[t[0]];
        texels = std::abs(p.x() * q.y() - p.y() * q.x()) *
                 static_cast<float>(scene.materials[scene.material_of[f]].texture.size());
      }
      normals.push_back({normal.x(), normal.y(), normal.z(), texels});
      labels.push_back({scene.class_of[f], scene.instance_of[f]});
    }
    fill(GL_ELEMENT_ARRAY_BUFFER, triangles);
    const auto per_face = [&](GLenum unit, GLenum format, const auto& data) {
      GLuint texture = 0;
      gl_.GenTextures(1, &texture);
      gl_.ActiveTexture(unit);
      gl_.BindTexture(GL_TEXTURE_BUFFER, texture);
      GLuint buffer = 0;
      gl_.GenBuffers(1, &buffer);
      gl_.BindBuffer(GL_TEXTURE_BUFFER, buffer);
      gl_.BufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(data.size() * sizeof(data[0])),
                     data.data(), GL_STATIC_DRAW);
      gl_.TexBuffer(GL_TEXTURE_BUFFER, format, buffer);
    };
    per_face(GL_TEXTURE1, GL_RGBA32F, normals);
    per_face(GL_TEXTURE2, GL_RG16UI, labels);
    gl_.ActiveTexture(GL_TEXTURE0);
  }

  /// Renderbuffers of the picture's size: linear color, labels, depth, depth test.
  void prepare_targets(int width, int height) const {
    if (targets_.empty()) {
      targets_.resize(4);
      gl_.GenRenderbuffers(4, targets_.data());
      gl_.GenFramebuffers(1, &framebuffer_);
    }
    gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    gl_.Viewport(0, 0, width, height);
    if (width == width_ && height == height_) return;
    width_ = width, height_ = height;
    const GLenum color = has_panes_ ? GL_RGBA32F : GL_RGBA16;
    const std::array<GLenum, 4> formats = {color, GL_RG16UI, GL_R32F, GL_DEPTH_COMPONENT32F};
    constexpr std::array<GLenum, 4> kPlaces = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1,
                                               GL_COLOR_ATTACHMENT2, GL_DEPTH_ATTACHMENT};
    for (std::size_t i = 0; i < 4; ++i) {
      gl_.BindRenderbuffer(GL_RENDERBUFFER, targets_[i]);
      gl_.RenderbufferStorage(GL_RENDERBUFFER, formats[i], width, height);
      gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, kPlaces[i], GL_RENDERBUFFER, targets_[i]);
    }
    gl_.DrawBuffers(3, kPlaces.data());
    if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw MachineError(fmt::format("OSMesa cannot draw {} x {} pixels", width, height));
  }

  void set_view(const Camera& camera, const SE3& world_from_camera) const {
    const double w = camera.width_px, h = camera.height_px;
    Eigen::Matrix4f clip_from_camera = Eigen::Matrix4f::Zero();
    clip_from_camera(0, 0) = static_cast<float>(2.0 * camera.fx_px / w);
    clip_from_camera(1, 1) = static_cast<float>(2.0 * camera.fy_px / h);
    // OpenGL's pixel centers lie at half-integers, ours at integers.
    clip_from_camera(0, 2) = static_cast<float>(2.0 * (camera.cx_px + 0.5) / w - 1.0);
    clip_from_camera(1, 2) = static_cast<float>(2.0 * (camera.cy_px + 0.5) / h - 1.0);
    clip_from_camera(2, 3) = kNearM;
    clip_from_camera(3, 2) = 1.0F;
    const Eigen::Matrix3f camera_from_world =
        world_from_camera.rotation().transpose().cast<float>();
    const Vector3f origin = world_from_camera.translation().cast<float>();
    gl_.UniformMatrix4fv(place("clip_from_camera"), 1, GL_FALSE, clip_from_camera.data());
    gl_.UniformMatrix3fv(place("camera_from_world"), 1, GL_FALSE, camera_from_world.data());
    gl_.Uniform3fv(place("origin"), 1, origin.data());
    gl_.Uniform1f(place("pixel_area"), static_cast<float>(1.0 / (camera.fx_px * camera.fy_px)));
  }

  void draw(const Batch& batch) const {
    gl_.Uniform1i(place("first_face"), batch.first);
    gl_.Uniform1i(place("textured"), batch.texture != 0);
    gl_.Uniform3fv(place("base"), 1, batch.base.data());
    gl_.Uniform3fv(place("emission"), 1, batch.emission.data());
    gl_.Uniform1i(place("has_holes"), batch.opacity != 0);
    if (batch.opacity != 0) {
      gl_.ActiveTexture(GL_TEXTURE3);
      gl_.BindTexture(GL_TEXTURE_2D, batch.opacity);
      gl_.ActiveTexture(GL_TEXTURE0);
    }
    gl_.BindTexture(GL_TEXTURE_2D, batch.texture);
    const std::size_t bytes = static_cast<std::size_t>(batch.first) * 3 * sizeof(std::uint32_t);
    gl_.DrawElements(GL_TRIANGLES, 3 * batch.count, GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(bytes));
  }

  /// Panes take their share of the light behind them, in whatever order; nothing else changes.
  void draw_panes() const {
    gl_.Enablei(GL_BLEND, 0);
    gl_.BlendFunc(GL_ZERO, GL_SRC_COLOR);
    gl_.DepthMask(GL_FALSE);
    for (const GLuint target : {1U, 2U})
      gl_.ColorMaski(target, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    for (const Batch& batch : batches_)
      if (batch.pane) draw(batch);
    for (const GLuint target : {1U, 2U}) gl_.ColorMaski(target, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl_.DepthMask(GL_TRUE);
    gl_.Disablei(GL_BLEND, 0);
  }

  RenderedFrame read_back(int width, int height) const {
    RenderedFrame frame;
    frame.color = Grid2d<Rgb8>(width, height);
    frame.depth_m = Grid2d<float>(width, height);
    frame.classes = Grid2d<ClassId>(width, height);
    frame.instances = Grid2d<InstanceId>(width, height);
    std::vector<std::array<float, 4>> color(frame.color.size());
    std::vector<std::array<std::uint16_t, 2>> label(color.size());
    const auto read = [&](GLenum from, GLenum format, GLenum type, void* to) {
      gl_.ReadBuffer(from);
      gl_.ReadPixels(0, 0, width, height, format, type, to);
    };
    read(GL_COLOR_ATTACHMENT0, GL_RGBA, GL_FLOAT, color.data());
    read(GL_COLOR_ATTACHMENT1, GL_RG_INTEGER, GL_UNSIGNED_SHORT, label.data());
    read(GL_COLOR_ATTACHMENT2, GL_RED, GL_FLOAT, frame.depth_m.data());
    for (std::size_t i = 0; i < color.size(); ++i) {
      frame.color.data()[i] = {linear_to_srgb(color[i][0]), linear_to_srgb(color[i][1]),
                               linear_to_srgb(color[i][2])};
      frame.classes.data()[i] = static_cast<ClassId>(label[i][0]);
      frame.instances.data()[i] = label[i][1];
    }
    return frame;
  }

  OffscreenContext context_;
  const Gl& gl_;
  float exposure_;  // of pictures, see RenderedFrame
  GLuint program_ = 0;
  std::vector<Batch> batches_;
  bool has_panes_ = false;
  std::array<float, 4> sky_{};  // linear x exposure
  mutable std::mutex mutex_;    // guards the context and what follows
  mutable std::vector<GLuint> targets_;
  mutable GLuint framebuffer_ = 0;
  mutable int width_ = 0, height_ = 0;
};

}  // namespace
#endif

std::unique_ptr<Renderer> make_osmesa_renderer([[maybe_unused]] const Scene& scene,
                                               [[maybe_unused]] const RenderConfig& config) {
#ifdef MH_HAS_OSMESA
  validate(scene);
  return std::make_unique<OsmesaRenderer>(scene, config);
#else
  throw MachineError(
      "this build has no OSMesa: install libosmesa6-dev and build again, or render with embree");
#endif
}

std::unique_ptr<Renderer> make_renderer(std::string_view name, const Scene& scene,
                                        const RenderConfig& config) {
  if (name == "embree") return make_embree_renderer(scene, config);
  if (name == "osmesa") return make_osmesa_renderer(scene, config);
  throw InputError(fmt::format("renderer '{}' is none of embree, osmesa", name));
}

}  // namespace mh
