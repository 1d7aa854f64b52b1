// SPDX-License-Identifier: Apache-2.0
#include "slam/occupancy/voxel_map.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sstream>

#include <gtest/gtest.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <xxhash.h>

#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/occupancy/objects.hpp"
#include "tests/slam/occupancy/box_room.hpp"
#include "tests/slam/occupancy/made_map.hpp"

namespace mh {
namespace {

using Eigen::Vector3d;

std::string bytes_of(const VoxelMap& map) {
  std::ostringstream out;
  map.write_ot(out);
  return std::move(out).str();
}

std::string in_temporary(const std::string& name) {
  return testing::TempDir() + name;
}

TEST(VoxelMap, ABoxRoomIsFreeInsideAndOccupiedAtItsWalls) {
  const OccupancyMapper mapper = mapped_room();
  const VoxelMap& map = mapper.map();
  EXPECT_EQ(map.state_at({0.5, 0.3, 0.6}), VoxelState::kFree);
  EXPECT_EQ(map.state_at({2.02, 0.3, 0.6}), VoxelState::kOccupied);
  EXPECT_EQ(map.state_at({-1.52, 0.3, 0.6}), VoxelState::kOccupied);
  EXPECT_EQ(map.state_at({2.3, 0.3, 0.6}), VoxelState::kUnknown);
  EXPECT_EQ(map.state_at({1.5, 0.0, 0.02}), VoxelState::kOccupied);  // the floor, seen at a slant
  map.for_each([&](const Voxel& voxel) {
    const Vector3d center = voxel.center_m(0.05);
    const double outside = std::max((kRoomMin - center).maxCoeff(), (center - kRoomMax).maxCoeff());
    if (voxel.occupied)
      EXPECT_LT(std::abs(outside), 0.03) << center.transpose();
    else
      EXPECT_LT(outside, 0.0) << center.transpose();
  });
}

TEST(VoxelMap, EveryVoxelOfTheSurfacesWithinTheImageIsOccupied) {
  const OccupancyMapper mapper = mapped_room();
  for (double z = 0.2; z < 0.8; z += 0.05)
    for (double y = -0.9; y < 1.2; y += 0.05)
      EXPECT_EQ(mapper.map().state_at({2.02, y, z}), VoxelState::kOccupied) << y << " " << z;
}

TEST(VoxelMap, BeyondTheRangeNothingIsSeen) {
  const OccupancyMapper mapper = mapped_room(0.8);
  std::size_t free = 0;
  mapper.map().for_each([&](const Voxel& voxel) {
    EXPECT_LT((voxel.center_m(0.05) - kEye).norm(), 0.85);
    free += voxel.occupied ? 0 : 1;
  });
  EXPECT_GT(free, 1000u);
}

TEST(VoxelMap, WhereThereIsNoReturnNothingIsTold) {
  OccupancyMapper mapper(room_camera(), every_pixel());
  RgbdFrame frame = room_frame(0, room_pose(0));
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 80; ++x) frame.depth_m(x, y) = 0;  // no depth in the left half
  mapper.keep(frame);
  mapper.update({{0, room_pose(0)}});
  EXPECT_GT(mapper.map().voxel_count(), 1000u);
  mapper.map().for_each([&](const Voxel& voxel) {
    EXPECT_LT(voxel.center_m(0.05).y(), kEye.y() + 0.03);  // y points left
  });
}

TEST(VoxelMap, VotesAreOfTheClassThatIsSeen) {
  const OccupancyMapper mapper = mapped_room();
  std::size_t labeled = 0;
  mapper.map().for_each([&](const Voxel& voxel) {
    if (voxel.label == kVoid) return;
    ++labeled;
    EXPECT_TRUE(voxel.occupied);
    if (std::abs(voxel.center_m(0.05).x()) < 1 && std::abs(voxel.center_m(0.05).y()) < 0.9) {
      EXPECT_TRUE(voxel.label == kFloorLabel || voxel.label == kCeilingLabel);
    }
    EXPECT_LE(voxel.label_views, voxel.votes);
    EXPECT_LE(voxel.votes, voxel.hits);
  });
  EXPECT_GT(labeled, 1000u);
}

// No matter in which order keyframes are added, moved and removed, the map equals one built at
// once.
TEST(VoxelMap, IsAFunctionOfItsKeyframesPosesAlone) {
  OccupancyMapper changed(room_camera(), every_pixel());
  Trajectory poses = look_around();
  for (std::size_t i = 0; i < poses.size(); i += 2)
    changed.keep(room_frame(poses[i].stamp_ns, poses[i].world_from_camera));
  changed.update(look_around(0.30));
  for (std::size_t i = 1; i < poses.size(); i += 2)
    changed.keep(room_frame(poses[i].stamp_ns, poses[i].world_from_camera));
  Trajectory some(poses.begin() + 5, poses.end());
  EXPECT_EQ(changed.update(some).removed, 3u);  // 0, 2, 4
  const std::string part = bytes_of(changed.map());
  OccupancyUpdate update = changed.update(poses);
  EXPECT_EQ(update.added, 5u);
  EXPECT_EQ(update.kept, 11u);
  EXPECT_EQ(update.moved, 0u);
  changed.keep(room_frame(3, room_pose(0.1)));  // seen again after a rewind, in a different image
  changed.keep(room_frame(3, poses[3].world_from_camera));
  changed.update(poses);
  EXPECT_EQ(bytes_of(changed.map()), bytes_of(mapped_room().map()));

  OccupancyMapper at_once(room_camera(), every_pixel());
  for (const TimedPose& pose : some)
    at_once.keep(room_frame(pose.stamp_ns, pose.world_from_camera));
  at_once.update(some);
  EXPECT_EQ(bytes_of(at_once.map()), part);
}

TEST(VoxelMap, OnlyKeyframesThatMovedAreToldAnew) {
  OccupancyMapper mapper = mapped_room();
  const std::string before = bytes_of(mapper.map());
  Trajectory poses = look_around();
  poses[4].world_from_camera = SE3(
      poses[4].world_from_camera.rotation(),
      poses[4].world_from_camera.translation() + Vector3d(0.001, 0, 0));  // less than half a step
  EXPECT_EQ(mapper.update(poses).kept, 16u);
  EXPECT_EQ(bytes_of(mapper.map()), before);
  poses[4] = {4, room_pose(4 * std::numbers::pi / 8, 0.2)};
  EXPECT_EQ(mapper.update(poses).moved, 1u);
  EXPECT_NE(bytes_of(mapper.map()), before);
  mapper.update({});
  EXPECT_TRUE(mapper.map().empty());
  EXPECT_EQ(bytes_of(mapper.map()), bytes_of(VoxelMap(0.05)));
}

TEST(VoxelMap, FilesRestoreEveryCount) {
  const OccupancyMapper mapper = mapped_room();
  const std::string file = in_temporary("voxel_map.ot");
  mapper.map().save_ot(file);
  const VoxelMap back = VoxelMap::load_ot(file);
  EXPECT_EQ(bytes_of(back), bytes_of(mapper.map()));
  EXPECT_EQ(back.voxel_count(), mapper.map().voxel_count());
  EXPECT_EQ(back.votes_at({2.02, 0.3, 0.6}), mapper.map().votes_at({2.02, 0.3, 0.6}));
  EXPECT_FALSE(back.votes_at({2.02, 0.3, 0.6}).empty());
}

TEST(VoxelMap, FilesKeepDetectedObjects) {
  MadeMap made;
  made.box({-3, 0, 0}, {2, 2, 2}, 5, 1);
  made.box({3, 0, 0}, {6, 2, 2}, 5, 2);
  VoxelMap map = made.map();
  const std::string before = bytes_of(map);
  DetectionAssociation association;
  association.add(made.view());
  map.set_detected(association.objects(map));
  EXPECT_NE(map.detected().at({2, 1, 1}), map.detected().at({3, 1, 1}));
  EXPECT_EQ(map.detected().at({1, 1, 1}), map.detected().at({2, 1, 1}));
  std::istringstream in(bytes_of(map));
  const VoxelMap back = VoxelMap::read_ot(in, "it");
  EXPECT_EQ(back.detected().entries().size(), map.detected().entries().size());
  EXPECT_EQ(back.detected().apart(), map.detected().apart());
  EXPECT_EQ(back.detected().apart().size(), 1u);
  EXPECT_EQ(bytes_of(back), bytes_of(map));
  EXPECT_NE(bytes_of(map), before);
}

TEST(VoxelMap, FilesKeepWhetherTheyStandOnAFloor) {
  MadeMap made;
  made.box({0, 0, 0}, {2, 2, 2}, 5, 1);
  VoxelMap map = made.map();
  EXPECT_TRUE(map.on_floor());
  const std::string standing = bytes_of(map);
  map.set_on_floor(false);
  std::istringstream in(bytes_of(map)), other(standing);
  const VoxelMap back = VoxelMap::read_ot(in, "it");
  EXPECT_FALSE(back.on_floor());
  EXPECT_EQ(bytes_of(back), bytes_of(map));
  EXPECT_NE(bytes_of(map), standing);
  EXPECT_TRUE(VoxelMap::read_ot(other, "it").on_floor());
}

/// The first version had no detected objects; before the third, the checksum did not cover the
/// tree.
TEST(VoxelMap, FilesOfOlderVersionsAreRead) {
  const OccupancyMapper mapper = mapped_room();
  const std::string now = bytes_of(mapper.map());
  const std::string magic = "modelhouse voxel counts 3\n";
  const std::size_t at = now.find(magic);
  ASSERT_NE(at, std::string::npos);
  for (const char* version : {"1", "2"}) {
    std::string content = now.substr(at + magic.size() + 8);
    content.resize(content.size() - 8);  // the checksum
    ASSERT_EQ(content.substr(8, 8), std::string(8, '\0'));
    if (*version == '1') content.erase(8, 8);
    std::string bytes = now.substr(0, at) + "modelhouse voxel counts " + version + "\n";
    const auto put = [&](std::uint64_t number) {
      bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
    };
    put(content.size());
    bytes += content;
    put(XXH3_64bits(content.data(), content.size()));
    std::istringstream in(bytes);
    EXPECT_EQ(bytes_of(VoxelMap::read_ot(in, "it")), now) << version;
  }
}

void expect_refused(const std::string& bytes, const std::string& message) {
  std::istringstream in(bytes);
  try {
    VoxelMap::read_ot(in, "it");
    ADD_FAILURE() << "was read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
  }
}

TEST(VoxelMap, DamagedFilesAreRefused) {
  const std::string good = bytes_of(mapped_room().map());
  expect_refused("", "is not an OctoMap file");
  expect_refused("P5\n", "is not an OctoMap file");
  expect_refused(good.substr(0, 40), "truncated");
  for (const std::size_t size : {good.size() / 9, good.size() / 2, good.size() - 1})
    expect_refused(good.substr(0, size), "");
  std::string flipped = good;
  flipped[good.size() - 100] = static_cast<char>(flipped[good.size() - 100] ^ 4);
  expect_refused(flipped, "checksum");
  flipped = good;  // the log-odds of the root, which octovis would show
  const std::size_t tree = good.find("\ndata\n") + 6;
  flipped[tree] = static_cast<char>(flipped[tree] ^ 4);
  expect_refused(flipped, "checksum");
  const auto with_header = [&](const std::string& key, const std::string& value) {
    const std::size_t at = good.find("\n" + key + " ") + key.size() + 2;
    return good.substr(0, at) + value + good.substr(good.find('\n', at));
  };
  expect_refused(with_header("size", "1"), "its tree does not have the 1 nodes that it declares");
  expect_refused(with_header("res", "nan"), "its resolution 'nan' is not a number");
  std::ostringstream binary;
  mapped_room().map().write_bt(binary);
  expect_refused(binary.str(), "without classes");
  expect_refused(good + "x", "after its end");
  octomap::ColorOcTree other(0.05);
  other.updateNode(octomap::point3d(0, 0, 0), true);
  std::ostringstream out;
  other.write(out);
  expect_refused(out.str(), "another program");
  EXPECT_THROW(VoxelMap::load_ot("/no/such/map.ot"), InputError);
  EXPECT_THROW(mapped_room().map().save_ot("/no/such/folder/map.ot"), InputError);
  EXPECT_THROW(mapped_room().map().save_bt("/no/such/folder/map.bt"), InputError);
}

/// A floor, a wall, free space between and a pruned cube, around the origin.
template <class Tree>
void fill(Tree& tree) {
  for (int x = -12; x < 12; ++x)
    for (int y = -7; y < 9; ++y) {
      tree.updateNode(octomap::OcTreeKey(32768 + x, 32768 + y, 32767), true);
      for (int z = 0; z < 20; ++z)
        tree.updateNode(octomap::OcTreeKey(32768 + x, 32768 + y, 32768 + z), x == 5);
    }
  for (int i = 0; i < 16 * 16 * 16; ++i)
    tree.setNodeValue(octomap::OcTreeKey(32768 + 64 + i % 16, 32768 + i / 16 % 16, 32768 + i / 256),
                      2.0F);
  tree.updateInnerOccupancy();
  tree.prune();
}

/// Loads another program's file; its known voxels must be those of the tree.
template <class Tree>
void expect_alike(const std::string& file, const Tree& tree) {
  std::vector<std::string> notes;
  const VoxelMap map = VoxelMap::load_octree(file, notes);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("it has no classes"), std::string::npos) << notes[0];
  EXPECT_EQ(map.voxel_count(), 24U * 16 * 21 + 16 * 16 * 16);
  map.for_each([&](const Voxel& voxel) {
    const Vector3d c = voxel.center_m(0.05);
    const auto* node = tree.search(c.x(), c.y(), c.z());
    ASSERT_NE(node, nullptr) << c.transpose();
    EXPECT_EQ(voxel.occupied, tree.isNodeOccupied(node)) << c.transpose();
    EXPECT_EQ(voxel.votes, 0U);
  });
}

TEST(VoxelMap, OctreesOfOtherProgramsAreReadWithoutClasses) {
  octomap::OcTree plain(0.05);
  octomap::ColorOcTree colored(0.05);
  fill(plain);
  fill(colored);
  const std::string ot = in_temporary("foreign.ot"), bt = in_temporary("foreign.bt"),
                    color = in_temporary("foreign_color.ot");
  ASSERT_TRUE(plain.write(ot) && plain.writeBinaryConst(bt) && colored.write(color));
  expect_alike(ot, plain);
  expect_alike(bt, plain);
  expect_alike(color, colored);
  std::vector<std::string> notes;
  mapped_room().map().save_ot(ot);
  EXPECT_EQ(bytes_of(VoxelMap::load_octree(ot, notes)), bytes_of(mapped_room().map()));
  EXPECT_TRUE(notes.empty()) << "our own";
}

TEST(VoxelMap, DamagedOctreesOfOtherProgramsAreRefused) {
  const std::string file = in_temporary("foreign_damaged.ot");
  const auto expect = [&](const std::string& bytes, const std::string& message) {
    write_atomically(file, bytes);
    std::vector<std::string> notes;
    try {
      VoxelMap::load_octree(file, notes);
      ADD_FAILURE() << "was read: " << message;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  };
  octomap::OcTree tree(0.05);
  fill(tree);
  std::ostringstream full, binary;
  tree.write(full);
  tree.writeBinaryConst(binary);
  for (const std::string& good : {full.str(), binary.str()})
    for (std::size_t size = good.find("\ndata\n") + 6; size < good.size(); size += 97)
      expect(good.substr(0, size), "is truncated");
  const std::string head = "\nid OcTree\nsize 9\nres 0.05\ndata\n";
  expect("# Octomap OcTree binary file" + head + std::string(100, '\xFF'), "too deep");
  expect("# Octomap OcTree binary file" + head + "\x01" + std::string(1, '\0'),
         "holds 35184372088832 voxels of 0.05 m, at most 30000000 are read");
  expect("# Octomap OcTree file\nid SemanticOcTree\nsize 9\nres 0.05\ndata\n", "SemanticOcTree");
}

TEST(VoxelMap, OctoMapReadsTheFilesWithColorsOfClasses) {
  const OccupancyMapper mapper = mapped_room();
  const std::string ot = in_temporary("octomap_reads.ot"), bt = in_temporary("octomap_reads.bt");
  mapper.map().save_ot(ot);
  mapper.map().save_bt(bt);
  const std::unique_ptr<octomap::AbstractOcTree> any(octomap::AbstractOcTree::read(ot));
  const auto* colored = dynamic_cast<octomap::ColorOcTree*>(any.get());
  ASSERT_NE(colored, nullptr);
  octomap::OcTree binary(0.1);
  ASSERT_TRUE(binary.readBinary(bt));
  EXPECT_DOUBLE_EQ(binary.getResolution(), 0.05);
  std::size_t checked = 0;
  mapper.map().for_each([&](const Voxel& voxel) {
    const Vector3d c = voxel.center_m(0.05);
    const auto* in_colored = colored->search(c.x(), c.y(), c.z());
    const auto* in_binary = binary.search(c.x(), c.y(), c.z());
    ASSERT_TRUE(in_colored && in_binary) << c.transpose();
    EXPECT_EQ(colored->isNodeOccupied(in_colored), voxel.occupied);
    EXPECT_EQ(binary.isNodeOccupied(in_binary), voxel.occupied);
    if (!voxel.occupied || voxel.label == kVoid) return;
    const ClassInfo& info = classes()[voxel.label];
    EXPECT_TRUE(in_colored->getColor() == octomap::ColorOcTreeNode::Color(info.r, info.g, info.b));
    ++checked;
  });
  EXPECT_GT(checked, 1000u);
  EXPECT_EQ(binary.search(0, 0, 5), nullptr);
}

// Debian's octomap-tools: convert_octree reads any tree, bt2vrml a binary one.
TEST(VoxelMap, OctoMapsOwnToolsOpenTheFiles) {
  if (std::system("command -v convert_octree bt2vrml > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "octomap-tools is not installed";
  const OccupancyMapper mapper = mapped_room();
  const std::string ot = in_temporary("tools.ot"), bt = in_temporary("tools.bt"),
                    converted = in_temporary("tools_converted.bt"), drawn = bt + ".wrl";
  mapper.map().save_ot(ot);
  mapper.map().save_bt(bt);
  for (const std::string& made : {converted, drawn}) std::remove(made.c_str());
  EXPECT_EQ(std::system(("convert_octree " + ot + " " + converted + " > /dev/null 2>&1").c_str()),
            0);
  octomap::OcTree back(0.1), direct(0.1);
  ASSERT_TRUE(back.readBinary(converted));
  ASSERT_TRUE(direct.readBinary(bt));
  EXPECT_EQ(back.getNumLeafNodes(), direct.getNumLeafNodes());
  EXPECT_EQ(std::system(("bt2vrml " + bt + " > /dev/null 2>&1").c_str()), 0);
  EXPECT_TRUE(is_file(drawn));
}

TEST(OccupancyMapper, DetectionsOfOneClassBecomeTwoObjects) {
  OccupancyMapper mapper(room_camera());
  RgbdFrame frame;
  const Camera camera = room_camera();
  frame.depth_m = Grid2d<float>(camera.width_px, camera.height_px, 1.5F);
  frame.semantics.index = Grid2d<std::uint8_t>(camera.width_px, camera.height_px, 1);
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = camera.width_px / 2; x < camera.width_px; ++x) frame.semantics.index(x, y) = 2;
  frame.semantics.palette = {{}, ClassDistribution::one_hot(5), ClassDistribution::one_hot(5)};
  mapper.keep(frame);
  const Trajectory poses{{.stamp_ns = 0, .world_from_camera = {}}};
  mapper.update(poses);
  EXPECT_EQ(find_objects(mapper.map()).size(), 1u);
  mapper.associate_detections();
  EXPECT_EQ(find_objects(mapper.map()).size(), 2u);
  mapper.update(poses);
  EXPECT_TRUE(mapper.map().detected().entries().empty()) << "is older than the poses";
}

TEST(OccupancyMapper, RefusesSettingsOutOfRangeAndFramesOfAnotherSize) {
  OccupancyConfig config;
  config.depth.resolution_m = 0;
  EXPECT_THROW(OccupancyMapper(room_camera(), config), InputError);
  config = {};
  config.depth.max_range_m = 13;  // more than 250 voxels
  EXPECT_THROW(OccupancyMapper(room_camera(), config), InputError);
  config = {};
  config.stride_px = 0;
  EXPECT_THROW(OccupancyMapper(room_camera(), config), InputError);
  OccupancyMapper mapper(room_camera());
  RgbdFrame frame;
  frame.depth_m = Grid2d<float>(10, 10);
  EXPECT_THROW(mapper.keep(frame), InputError);
}

}  // namespace
}  // namespace mh
