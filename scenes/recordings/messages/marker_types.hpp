// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenes/recordings/messages/types.hpp"

namespace mh::ros {

struct ColorRgba {
  static constexpr const char* kType = "std_msgs/ColorRGBA";
  float r = 0, g = 0, b = 0, a = 1;  ///< 0 to 1
  static void fields(auto& m, auto& f) {
    f("r", m.r);
    f("g", m.g);
    f("b", m.b);
    f("a", m.a);
  }
};

struct UvCoordinate {
  static constexpr const char* kType = "visualization_msgs/UVCoordinate";
  float u = 0, v = 0;
  static void fields(auto& m, auto& f) {
    f("u", m.u);
    f("v", m.v);
  }
};

struct MeshFile {
  static constexpr const char* kType = "visualization_msgs/MeshFile";
  std::string filename;
  Bytes data;
  static void fields(auto& m, auto& f) {
    f("filename", m.filename);
    f("data", m.data);
  }
};

/// A shape that RViz and Foxglove draw.
struct Marker {
  static constexpr const char* kType = "visualization_msgs/Marker";
  static constexpr const char* kMd5 = "4048c9de2a16f4ae8e0538085ebf1b97";
  static constexpr std::uint8_t kCube = 1, kCubeList = 6, kText = 9, kAdd = 0;
  Header header;
  std::string ns;  ///< together with id, identifies the marker that this one replaces
  std::int32_t id = 0;
  std::int32_t type = kCube;
  std::int32_t action = kAdd;
  Pose pose;
  Vector3 scale;  ///< m; for text, z is the height of a letter
  ColorRgba color;
  Duration lifetime;  ///< 0: forever
  bool frame_locked = false;
  std::vector<Point> points;      ///< for lists
  std::vector<ColorRgba> colors;  ///< of the points
  std::string texture_resource;
  CompressedImage texture;
  std::vector<UvCoordinate> uv_coordinates;
  std::string text;
  std::string mesh_resource;
  MeshFile mesh_file;
  bool mesh_use_embedded_materials = false;
  static void fields(auto& m, auto& f) {
    constexpr const char* kTypes[] = {
        "ARROW",     "CUBE",        "SPHERE", "CYLINDER",         "LINE_STRIP",    "LINE_LIST",
        "CUBE_LIST", "SPHERE_LIST", "POINTS", "TEXT_VIEW_FACING", "MESH_RESOURCE", "TRIANGLE_LIST"};
    for (std::uint8_t i = 0; const char* name : kTypes) f.constant(name, i++);
    f.constant("ADD", kAdd);
    f.constant("MODIFY", kAdd);
    f.constant("DELETE", std::uint8_t{2});
    f.constant("DELETEALL", std::uint8_t{3});
    f("header", m.header);
    f("ns", m.ns);
    f("id", m.id);
    f("type", m.type);
    f("action", m.action);
    f("pose", m.pose);
    f("scale", m.scale);
    f("color", m.color);
    f("lifetime", m.lifetime);
    f("frame_locked", m.frame_locked);
    f("points", m.points);
    f("colors", m.colors);
    f.ros2("texture_resource", m.texture_resource);
    f.ros2("texture", m.texture);
    f.ros2("uv_coordinates", m.uv_coordinates);
    f("text", m.text);
    f("mesh_resource", m.mesh_resource);
    f.ros2("mesh_file", m.mesh_file);
    f("mesh_use_embedded_materials", m.mesh_use_embedded_materials);
  }
};

struct MarkerArray {
  static constexpr const char* kType = "visualization_msgs/MarkerArray";
  static constexpr const char* kMd5 = "d155b9ce5188fbaf89745847fd5882d7";
  std::vector<Marker> markers;
  static void fields(auto& m, auto& f) { f("markers", m.markers); }
};

}  // namespace mh::ros
