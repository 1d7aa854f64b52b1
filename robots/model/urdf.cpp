// SPDX-License-Identifier: Apache-2.0
#include "robots/model/urdf.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <tinyxml2.h>
#include <urdf_parser/urdf_parser.h>
#include <Eigen/Eigenvalues>

#include "robots/model/xacro.hpp"
#include "slam/io/error.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

/// Captures what urdfdom would print.
class Messages : public console_bridge::OutputHandler {
 public:
  Messages() { console_bridge::useOutputHandler(this); }
  ~Messages() override { console_bridge::restorePreviousOutputHandler(); }
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_.empty()) first_ = text;
  }
  const std::string& first() const { return first_; }

 private:
  std::string first_;
};

/// Parses a URDF. @returns the model, or an error message
std::pair<urdf::ModelInterfaceSharedPtr, std::string> try_urdf(const std::string& text) {
  static std::mutex one_at_a_time;  // urdfdom has one message handler per process
  const std::scoped_lock lock(one_at_a_time);
  Messages messages;
  try {
    urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text);
    if (model && messages.first().empty()) return {model, ""};
  } catch (const std::exception& e) {
    return {nullptr, e.what()};
  }
  return {nullptr, messages.first().empty() ? "is not URDF" : messages.first()};
}

/// Finds the lines of links and joints in a file, which urdfdom does not report, and checks that
/// they are connected. Unnamed elements are left to urdfdom.
class Places {
 public:
  Places(const std::string& text, const std::filesystem::path& file) : file_(file.string()) {
    tinyxml2::XMLDocument document;
    if (document.Parse(text.c_str(), text.size()) != tinyxml2::XML_SUCCESS)
      throw InputError(
          fmt::format("{}:{}: is not XML", file_, std::max(1, document.ErrorLineNum())));
    const tinyxml2::XMLElement* robot = document.FirstChildElement("robot");
    if (robot == nullptr) return;
    for (auto* material = robot->FirstChildElement("material"); material != nullptr;
         material = material->NextSiblingElement("material"))
      materials_ += text_of(*material);
    for (auto* link = robot->FirstChildElement("link"); link != nullptr;
         link = link->NextSiblingElement("link"))
      if (const char* name = link->Attribute("name")) {
        line_of_link_.emplace(name, link->GetLineNum());
        links_.emplace_back(name, text_of(*link));
      }
    for (auto* joint = robot->FirstChildElement("joint"); joint != nullptr;
         joint = joint->NextSiblingElement("joint"))
      if (const char* name = joint->Attribute("name")) add_joint(*joint, name);
    for (const std::string& link : hanging_) check_way_up(link);
  }

  [[noreturn]] void fail_at_link(const std::string& name, const std::string& what) const {
    throw InputError(at_link(name, what));
  }
  [[noreturn]] void fail_at_joint(const std::string& name, const std::string& what) const {
    throw InputError(at("joint", name, line_of_joint_, what));
  }
  std::string at_link(const std::string& name, const std::string& what) const {
    return at("link", name, line_of_link_, what);
  }
  /// Throws urdfdom's message, with the first link or joint that it applies to.
  [[noreturn]] void fail_somewhere(const std::string& what) const {
    // Each part is parsed with all materials, which takes too long if there are very many of both.
    constexpr std::size_t kMostBytes = 50'000'000;
    if (materials_.size() * (links_.size() + joints_.size()) > kMostBytes)
      throw InputError(fmt::format("{}: {}", file_, what));
    const auto wrong_with = [&](const std::string& part) {
      return try_urdf("<robot name=\"r\">" + materials_ + part + "</robot>").second;
    };
    for (const auto& [name, text] : links_)
      if (const std::string wrong = wrong_with(text); !wrong.empty()) fail_at_link(name, wrong);
    for (const auto& [name, text] : joints_)
      if (const std::string wrong = wrong_with(text); !wrong.empty()) fail_at_joint(name, wrong);
    throw InputError(fmt::format("{}: {}", file_, what));
  }

 private:
  struct Way {
    std::string joint, parent;
  };

  static std::string text_of(const tinyxml2::XMLElement& element) {
    tinyxml2::XMLPrinter printer(nullptr, true);
    element.Accept(&printer);
    return printer.CStr();
  }

  void add_joint(const tinyxml2::XMLElement& joint, const std::string& name) {
    line_of_joint_.emplace(name, joint.GetLineNum());
    if (const tinyxml2::XMLElement* limit = joint.FirstChildElement("limit")) {
      const bool lower = limit->Attribute("lower") != nullptr;
      if (lower != (limit->Attribute("upper") != nullptr))
        fail_at_joint(name, lower ? "its limit has a lower end but no upper"
                                  : "its limit has an upper end but no lower");
    }
    const auto link_at = [&](const char* end) -> std::string {
      const tinyxml2::XMLElement* element = joint.FirstChildElement(end);
      const char* link = element == nullptr ? nullptr : element->Attribute("link");
      if (link == nullptr) return {};
      if (!line_of_link_.contains(link))
        fail_at_joint(name, fmt::format("its {} link '{}' is missing", end, link));
      return link;
    };
    const std::string parent = link_at("parent"), child = link_at("child");
    if (parent.empty() || child.empty()) return;
    const auto stub = [](const std::string& link) { return "<link name=\"" + link + "\"/>"; };
    joints_.emplace_back(name,
                         stub(parent) + (child == parent ? "" : stub(child)) + text_of(joint));
    const auto [other, first] = way_up_.emplace(child, Way{name, parent});
    if (!first)
      fail_at_joint(name, fmt::format("link '{}' is the child of two joints, '{}' and '{}'", child,
                                      other->second.joint, name));
    hanging_.push_back(child);
  }

  void check_way_up(const std::string& link) {
    std::set<std::string> passed;
    for (auto way = way_up_.find(link); way != way_up_.end() && !leads_up_.contains(way->first);
         way = way_up_.find(way->second.parent))
      if (!passed.insert(way->first).second)
        fail_at_joint(way->second.joint,
                      fmt::format("link '{}' is part of a cycle of joints, which no root leads to",
                                  way->first));
    leads_up_.merge(passed);
  }

  std::string at(const char* kind, const std::string& name, const std::map<std::string, int>& lines,
                 const std::string& what) const {
    const auto line = lines.find(name);
    return fmt::format("{}{}: {} '{}': {}", file_,
                       line == lines.end() ? "" : fmt::format(":{}", line->second), kind, name,
                       what);
  }

  std::string file_;
  std::map<std::string, int> line_of_link_, line_of_joint_;
  // Text of each element, for a small URDF that contains it alone: see fail_somewhere().
  std::string materials_;
  std::vector<std::pair<std::string, std::string>> links_, joints_;  // name, text
  std::map<std::string, Way> way_up_;                                // by child
  std::vector<std::string> hanging_;  // children, in the file's order
  std::set<std::string> leads_up_;    // those that check_way_up() has verified
};

SE3 to_se3(const urdf::Pose& pose) {
  const auto& q = pose.rotation;
  return {Eigen::Quaterniond(q.w, q.x, q.y, q.z),
          {pose.position.x, pose.position.y, pose.position.z}};
}

/// Describes a size that no shape can have; "" if the size is valid.
std::string wrong_size(const urdf::GeometrySharedPtr& shape) {
  if (!shape) return "";
  std::vector<std::pair<const char*, double>> sizes;
  if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(shape.get()))
    sizes = {{"radius of its sphere", sphere->radius}};
  if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(shape.get()))
    sizes = {{"radius of its cylinder", cylinder->radius},
             {"length of its cylinder", cylinder->length}};
  if (const auto* box = dynamic_cast<const urdf::Box*>(shape.get()))
    for (const double side : {box->dim.x, box->dim.y, box->dim.z})
      sizes.emplace_back("side of its box", side);
  for (const auto& [what, size_m] : sizes)
    if (!(size_m >= 0) || std::isinf(size_m)) return fmt::format("the {} is {} m", what, size_m);
  return "";
}

/// Describes moments of inertia that no body can have; "" if they are valid.
std::string wrong_moments(const urdf::Inertial& body) {
  Eigen::Matrix3d inertia;
  inertia << body.ixx, body.ixy, body.ixz, body.ixy, body.iyy, body.iyz, body.ixz, body.iyz,
      body.izz;
  // Principal moments of a body are not negative, and none exceeds the sum of the other two.
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvalues();
  if (moments[0] >= 0 && moments[2] <= (moments[0] + moments[1]) * (1 + 1e-6)) return "";
  return fmt::format("no body has the principal moments of inertia {:.6g}, {:.6g}, {:.6g} kg m2",
                     moments[0], moments[1], moments[2]);
}

Link read_link(const urdf::Link& from, const Places& places, std::vector<std::string>* warnings) {
  Link link{.name = from.name};
  const auto check = [&](const urdf::GeometrySharedPtr& shape) {
    if (const std::string wrong = wrong_size(shape); !wrong.empty())
      places.fail_at_link(from.name, wrong);
  };
  for (const auto& visual : from.visual_array) check(visual->geometry);
  for (const auto& collision : from.collision_array) check(collision->geometry);
  if (!from.inertial) return link;
  const urdf::Inertial& body = *from.inertial;
  if (!(body.mass >= 0) || std::isinf(body.mass))
    places.fail_at_link(from.name, fmt::format("its mass {} kg is not positive", body.mass));
  if (const std::string wrong = wrong_moments(body); warnings != nullptr && !wrong.empty())
    warnings->push_back(places.at_link(from.name, wrong + "; not used here"));
  link.mass_kg = body.mass;
  return link;
}

Joint read_joint(const urdf::Joint& from, const Places& places) {
  const auto fail = [&](const std::string& what) { places.fail_at_joint(from.name, what); };
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Joint joint{.name = from.name,
              .parent = from.parent_link_name,
              .child = from.child_link_name,
              .parent_from_child = to_se3(from.parent_to_joint_origin_transform)};
  switch (from.type) {
    case urdf::Joint::FIXED:
      return joint;
    case urdf::Joint::REVOLUTE:
    case urdf::Joint::CONTINUOUS:
      joint.kind = Joint::Kind::kTurning;
      break;
    case urdf::Joint::PRISMATIC:
      joint.kind = Joint::Kind::kSliding;
      break;
    default:
      fail("is neither fixed, revolute, continuous nor prismatic");
  }
  joint.axis = {from.axis.x, from.axis.y, from.axis.z};
  if (!(joint.axis.norm() > 1e-9)) fail("its axis has no direction");
  joint.axis.normalize();
  joint.lower = -kInf;
  joint.upper = joint.velocity = joint.effort = kInf;
  if (!from.limits) return joint;
  joint.velocity = from.limits->velocity;
  joint.effort = from.limits->effort;
  if (from.type != urdf::Joint::CONTINUOUS) {
    joint.lower = from.limits->lower;
    joint.upper = from.limits->upper;
  }
  if (joint.lower > joint.upper)
    fail(fmt::format("its lower limit {} is above its upper {}", joint.lower, joint.upper));
  if (!(joint.velocity >= 0))
    fail(fmt::format("its velocity limit {} is negative", joint.velocity));
  return joint;
}

/// Sorts joints so that each one's parent link precedes it: in the order in which repeated passes
/// would take them if each pass took every joint whose parent is known. The joints form a tree
/// (checked by Places).
std::vector<Joint> from_root(std::vector<Joint> joints, const std::string& root) {
  std::multimap<std::string_view, std::size_t> below;  // by parent
  for (std::size_t i = 0; i < joints.size(); ++i) below.emplace(joints[i].parent, i);
  struct Taken {
    std::size_t turn, joint;
    auto operator<=>(const Taken&) const = default;
  };
  std::vector<Taken> taken;
  const auto take_below = [&](std::string_view link, const auto& turn_of) {
    const auto [begin, end] = below.equal_range(link);
    for (auto found = begin; found != end; ++found)
      taken.push_back({turn_of(found->second), found->second});
  };
  take_below(root, [](std::size_t) { return std::size_t{0}; });
  for (std::size_t i = 0; i < taken.size(); ++i) {
    const Taken above = taken[i];
    take_below(joints[above.joint].child,
               [&](std::size_t joint) { return above.turn + (joint < above.joint); });
  }
  assert(taken.size() == joints.size());
  std::ranges::sort(taken);
  std::vector<Joint> ordered;
  for (const Taken& next : taken) ordered.push_back(std::move(joints[next.joint]));
  return ordered;
}

}  // namespace

double KinematicTree::mass_kg() const {
  double sum = 0;
  for (const Link& link : links) sum += link.mass_kg;
  return sum;
}

const Joint& KinematicTree::joint(std::string_view wanted) const {
  const auto found = std::ranges::find(joints, wanted, &Joint::name);
  if (found == joints.end())
    throw InputError(fmt::format("robot '{}': has no joint '{}'", name, wanted));
  return *found;
}

SE3 KinematicTree::root_from(std::string_view link,
                             const std::map<std::string, double>& positions) const {
  for (const auto& [moved, position] : positions) joint(moved);
  SE3 link_from_wanted;
  std::string here(link);
  if (std::ranges::find(links, here, &Link::name) == links.end())
    throw InputError(fmt::format("robot '{}': has no link '{}'", name, link));
  while (here != root) {
    const Joint& j = *std::ranges::find(joints, here, &Joint::child);
    const auto moved = positions.find(j.name);
    const double q = moved == positions.end() ? 0.0 : moved->second;
    SE3 motion;
    if (j.kind == Joint::Kind::kTurning) motion = SE3(so3_exp(q * j.axis), Eigen::Vector3d::Zero());
    if (j.kind == Joint::Kind::kSliding) motion = SE3(Eigen::Matrix3d::Identity(), q * j.axis);
    link_from_wanted = j.parent_from_child * motion * link_from_wanted;
    here = j.parent;
  }
  return link_from_wanted;
}

KinematicTree load_urdf(const std::filesystem::path& file, std::vector<std::string>* warnings) {
  const std::string text = with_xacro_names(read_text(file), file);
  const Places places(text, file);
  const auto [model, wrong] = try_urdf(text);
  if (!model) places.fail_somewhere(wrong);
  KinematicTree tree{.name = model->getName(), .root = model->getRoot()->name};
  for (const auto& [name, link] : model->links_)
    tree.links.push_back(read_link(*link, places, warnings));
  for (const auto& [name, joint] : model->joints_)
    tree.joints.push_back(read_joint(*joint, places));
  tree.joints = from_root(std::move(tree.joints), tree.root);
  return tree;
}

}  // namespace mh
