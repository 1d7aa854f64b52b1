// SPDX-License-Identifier: Apache-2.0
#include "sim/simulation/pedestrian.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "scenes/floor.hpp"
#include "scenes/mesh_builder.hpp"
#include "slam/io/yaml.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;
using Eigen::Vector3d;
using Eigen::Vector3f;

double length_m(const Pedestrian& pedestrian) {
  double sum = 0;
  for (std::size_t i = 1; i < pedestrian.path_m.size(); ++i)
    sum += (pedestrian.path_m[i] - pedestrian.path_m[i - 1]).norm();
  return sum;
}

/// The pedestrian's position along the line (m), and whether on the way back.
std::pair<double, bool> progress(const Pedestrian& pedestrian, Stamp stamp_ns) {
  const double on_his_way_s =
      std::max(0.0, 1e-9 * static_cast<double>(stamp_ns) - pedestrian.start_s);
  const double length = length_m(pedestrian);
  const double s = std::fmod(pedestrian.speed_m_per_s * on_his_way_s, 2 * length);
  return s <= length ? std::pair{s, false} : std::pair{2 * length - s, true};
}

/// Lights a person as in a room: more from above than from below.
void light_from_above(Scene& scene, const Vector3f& light) {
  std::vector<Vector3f> normal(scene.positions_m.size(), Vector3f::Zero());
  for (const auto& [a, b, c] : scene.triangles) {
    const Vector3f &pa = scene.positions_m[a], &pb = scene.positions_m[b],
                   &pc = scene.positions_m[c];
    const Vector3f across = (pb - pa).cross(pc - pa);
    for (const std::uint32_t corner : {a, b, c}) normal[corner] += across;
  }
  scene.light.clear();
  for (const Vector3f& n : normal)
    scene.light.push_back(light * (1.0F + 0.4F * n.normalized().z()));
}

Vector3f mean_light(const Scene& scene) {
  if (scene.light.empty()) return Vector3f::Ones();
  Vector3d sum = Vector3d::Zero();
  for (const Vector3f& light : scene.light) sum += light.cast<double>();
  return (sum / static_cast<double>(scene.light.size())).cast<float>();
}

/// The depth of the nearer surface.
float nearer_m(float depth_m, float other_m) {
  return other_m <= 0 || (depth_m > 0 && depth_m <= other_m) ? depth_m : other_m;
}

void merge(RenderedFrame& image, const RenderedFrame& pedestrian, InstanceId instance) {
  for (std::size_t i = 0; i < image.depth_m.size(); ++i) {
    const float near = pedestrian.depth_m.data()[i];
    float& depth = image.depth_m.data()[i];
    if (near <= 0 || (depth > 0 && depth <= near)) continue;
    depth = near;
    image.color.data()[i] = pedestrian.color.data()[i];
    image.classes.data()[i] = pedestrian.classes.data()[i];
    image.instances.data()[i] = instance;
  }
}

class Moment : public Renderer {
 public:
  Moment(const Renderer& scene, const Renderer& pedestrian, InstanceId instance,
         const SE3& world_from_pedestrian)
      : scene_(scene),
        body_(pedestrian),
        instance_(instance),
        body_from_world_(world_from_pedestrian.inverse()) {}

  RenderedFrame render(const Camera& camera, const SE3& world_from_camera) const override {
    RenderedFrame image = scene_.render(camera, world_from_camera);
    merge(image, body_.render(camera, body_from_world_ * world_from_camera), instance_);
    return image;
  }
  Grid2d<float> render_depth(const Camera& camera, const SE3& world_from_camera) const override {
    Grid2d<float> depth_m = scene_.render_depth(camera, world_from_camera);
    const Grid2d<float> body_m = body_.render_depth(camera, body_from_world_ * world_from_camera);
    std::ranges::transform(depth_m, body_m, depth_m.begin(), nearer_m);
    return depth_m;
  }
  std::vector<float> depth_at(const Camera& camera, const SE3& world_from_camera,
                              std::span<const Eigen::Vector2i> pixels) const override {
    std::vector<float> depth_m = scene_.depth_at(camera, world_from_camera, pixels);
    const std::vector<float> body_m =
        body_.depth_at(camera, body_from_world_ * world_from_camera, pixels);
    std::ranges::transform(depth_m, body_m, depth_m.begin(), nearer_m);
    return depth_m;
  }

 private:
  const Renderer& scene_;
  const Renderer& body_;
  InstanceId instance_;
  SE3 body_from_world_;
};

}  // namespace

Pedestrian load_pedestrian(const std::filesystem::path& file) {
  YamlReader yaml = YamlReader::load(file);
  Pedestrian pedestrian;
  const YamlReader path = yaml.at("path");
  for (const YamlReader& place : path.items()) {
    const std::vector<double> xy = place.as_numbers(2);
    pedestrian.path_m.emplace_back(xy[0], xy[1]);
    if (pedestrian.path_m.size() > 1 &&
        pedestrian.path_m.back() == pedestrian.path_m[pedestrian.path_m.size() - 2])
      place.fail("repeats the place before it");
  }
  if (pedestrian.path_m.size() < 2) path.fail("a path needs at least two places");
  pedestrian.speed_m_per_s = yaml.number_or("speed_m_per_s", pedestrian.speed_m_per_s, 0.01, 10.0);
  pedestrian.start_s = yaml.number_or("start_s", pedestrian.start_s, 0.0, 1e6);
  yaml.finish();
  return pedestrian;
}

SE3 world_from_pedestrian(const Pedestrian& pedestrian, Stamp stamp_ns) {
  assert(pedestrian.path_m.size() >= 2);
  auto [left_m, back] = progress(pedestrian, stamp_ns);
  std::size_t leg = 1;
  const auto leg_m = [&] { return (pedestrian.path_m[leg] - pedestrian.path_m[leg - 1]).norm(); };
  while (leg + 1 < pedestrian.path_m.size() && left_m > leg_m()) left_m -= leg_m(), ++leg;
  const Vector2d way = (pedestrian.path_m[leg] - pedestrian.path_m[leg - 1]) / leg_m();
  const Vector2d place = pedestrian.path_m[leg - 1] + std::min(left_m, leg_m()) * way;
  const Vector2d forward = back ? Vector2d(-way) : way;
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(std::atan2(forward.y(), forward.x()), Vector3d::UnitZ()).toRotationMatrix();
  return {rotation, {place.x(), place.y(), 0.0}};
}

Scene build_pedestrian(const Vector3f& light) {
  MeshBuilder mesh;
  mesh.scene().name = "pedestrian";
  const auto person = class_by_name("person");
  assert(person);
  mesh.begin_instance("pedestrian", *person);
  const MaterialId trousers = mesh.material(
      {.name = "trousers", .kind = "fabric", .tone = {58, 66, 88}, .variation = 0.6, .seed = 901});
  const MaterialId pullover = mesh.material(
      {.name = "pullover", .kind = "knit", .tone = {150, 74, 60}, .variation = 0.7, .seed = 902});
  const MaterialId skin = mesh.material(
      {.name = "skin", .kind = "leather", .tone = {204, 160, 132}, .variation = 0.2, .seed = 903});
  // Wide from side to side, narrower from front to back.
  Eigen::Isometry3f flat = Eigen::Isometry3f::Identity();
  flat.linear() = Vector3f(0.65F, 1.0F, 1.0F).asDiagonal();
  mesh.push(flat);
  constexpr auto kRadius = static_cast<float>(kPedestrianRadius_m);
  const std::array legs = {Vector2f(0.0F, 0.0F), Vector2f(0.15F, 0.0F), Vector2f(0.16F, 0.40F),
                           Vector2f(0.19F, 0.85F)};
  mesh.lathe(trousers, Vector3f::Zero(), legs);
  const std::array trunk = {Vector2f(0.19F, 0.85F), Vector2f(0.20F, 1.10F),
                            Vector2f(kRadius, 1.34F), Vector2f(0.17F, 1.43F),
                            Vector2f(0.07F, 1.48F)};
  mesh.lathe(pullover, Vector3f::Zero(), trunk);
  mesh.pop();
  std::vector<Vector2f> head;
  for (int i = 0; i <= 12; ++i) {  // an upright ellipsoid from the neck to the crown
    const float a = static_cast<float>(M_PI) * (static_cast<float>(i) / 12.0F - 0.5F);
    head.emplace_back(0.095F * std::cos(a), 1.58F + 0.14F * std::sin(a));
  }
  mesh.lathe(skin, Vector3f::Zero(), head);
  Scene scene = mesh.finish();
  light_from_above(scene, light);
  return scene;
}

InstanceId pedestrian_instance(const Scene& scene) {
  const int last = scene.instances.empty() ? 0 : scene.instances.back().id;
  assert(last < std::numeric_limits<InstanceId>::max());
  return static_cast<InstanceId>(last + 1);
}

PedestrianScene::PedestrianScene(const Scene& scene, std::shared_ptr<const Renderer> renderer,
                                 float exposure, Pedestrian pedestrian)
    : scene_(std::move(renderer)), pedestrian_(std::move(pedestrian)) {
  assert(scene_ != nullptr);
  // Smoothed edges would blend the surrounding void into the outline.
  body_ = make_embree_renderer(build_pedestrian(mean_light(scene)),
                               {.exposure = exposure, .antialiasing = Antialiasing::kNone});
  instance_ = pedestrian_instance(scene);
  world_from_floor_ = world_from_floor(scene.floor);
}

PedestrianScene::~PedestrianScene() = default;

std::shared_ptr<const Renderer> PedestrianScene::at(Stamp stamp_ns) const {
  return std::make_shared<Moment>(*scene_, *body_, instance_,
                                  world_from_floor_ * world_from_pedestrian(pedestrian_, stamp_ns));
}

}  // namespace mh
