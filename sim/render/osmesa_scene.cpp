// SPDX-License-Identifier: Apache-2.0
#include "sim/render/osmesa_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "sim/render/color.hpp"
#include "sim/render/texture.hpp"

#ifdef MH_HAS_OSMESA
namespace mh {
namespace {

using Eigen::Vector3f;

/// Sorts faces by material, otherwise keeping their order.
std::vector<std::uint32_t> sort_faces(const Scene& scene) {
  std::vector<std::uint32_t> order(scene.triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  if (!scene.materials.empty())
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return scene.material_of[a] < scene.material_of[b];
    });
  return order;
}

GLuint load_texture(const Gl& gl, const Grid2d<Rgb8>& image) {
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_2D, texture);
  const auto levels = mip_pyramid(image);
  for (std::size_t l = 0; l < levels.size(); ++l) {
    std::vector<std::uint16_t> texels;
    for (const Vector3f& c : levels[l])
      for (int k = 0; k < 4; ++k)
        texels.push_back(static_cast<std::uint16_t>(std::lround((k < 3 ? c[k] : 1.0F) * 65535)));
    gl.TexImage2D(GL_TEXTURE_2D, static_cast<GLint>(l), GL_RGBA16, levels[l].width(),
                  levels[l].height(), 0, GL_RGBA, GL_UNSIGNED_SHORT, texels.data());
  }
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, static_cast<GLint>(levels.size()) - 1);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return texture;
}

GLuint load_opacity(const Gl& gl, const Grid2d<std::uint8_t>& opacity) {
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.ActiveTexture(GL_TEXTURE3);
  gl.BindTexture(GL_TEXTURE_2D, texture);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, opacity.width(), opacity.height(), 0, GL_RED,
                GL_UNSIGNED_BYTE, opacity.data());
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl.ActiveTexture(GL_TEXTURE0);
  return texture;
}

std::vector<Batch> make_batches(const Gl& gl, const Scene& scene,
                                const std::vector<std::uint32_t>& order, float exposure) {
  std::vector<Batch> batches;
  if (scene.materials.empty()) {
    batches.push_back(
        {0, static_cast<int>(order.size()), 0, 0, Vector3f::Constant(exposure), Vector3f::Zero()});
    return batches;
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
        batch.texture = load_texture(gl, material.texture);
    }
    if (!material.opacity.empty() && !scene.uvs.empty() && material.emission.isZero())
      batch.opacity = load_opacity(gl, material.opacity);
    if (material.is_pane())
      batch = {.first = first,
               .count = end - first,
               .base = Vector3f::Zero(),
               .emission = material.transmission,
               .pane = true};
    batches.push_back(batch);
    first = end;
  }
  return batches;
}

template <class T>
void fill(const Gl& gl, GLenum target, const std::vector<T>& data) {
  GLuint buffer = 0;
  gl.GenBuffers(1, &buffer);
  gl.BindBuffer(target, buffer);
  gl.BufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(),
                GL_STATIC_DRAW);
}

void load_vertices(const Gl& gl, const Scene& scene) {
  GLuint array = 0;
  gl.GenVertexArrays(1, &array);
  gl.BindVertexArray(array);
  const auto attribute = [&](GLuint index, GLint size, const auto& data) {
    fill(gl, GL_ARRAY_BUFFER, data);
    gl.EnableVertexAttribArray(index);
    gl.VertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, 0, nullptr);
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

void load_faces(const Gl& gl, const Scene& scene, const std::vector<std::uint32_t>& order) {
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
  fill(gl, GL_ELEMENT_ARRAY_BUFFER, triangles);
  const auto per_face = [&](GLenum unit, GLenum format, const auto& data) {
    GLuint texture = 0;
    gl.GenTextures(1, &texture);
    gl.ActiveTexture(unit);
    gl.BindTexture(GL_TEXTURE_BUFFER, texture);
    GLuint buffer = 0;
    gl.GenBuffers(1, &buffer);
    gl.BindBuffer(GL_TEXTURE_BUFFER, buffer);
    gl.BufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(data.size() * sizeof(data[0])),
                  data.data(), GL_STATIC_DRAW);
    gl.TexBuffer(GL_TEXTURE_BUFFER, format, buffer);
  };
  per_face(GL_TEXTURE1, GL_RGBA32F, normals);
  per_face(GL_TEXTURE2, GL_RG16UI, labels);
  gl.ActiveTexture(GL_TEXTURE0);
}

}  // namespace

std::vector<Batch> load_scene(const Gl& gl, const Scene& scene, float exposure) {
  const std::vector<std::uint32_t> order = sort_faces(scene);
  std::vector<Batch> batches = make_batches(gl, scene, order, exposure);
  load_vertices(gl, scene);
  load_faces(gl, scene, order);
  return batches;
}

}  // namespace mh
#endif
