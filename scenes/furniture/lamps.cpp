// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "scenes/furniture/builders.hpp"

namespace mh::build {

using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

/// A cloth shade, open above and below, lit from inside. The glowing material is nearly black apart
/// from its own emission: the light source is so close that anything paler would reflect more light
/// than sunlit surfaces do.
void shade(Piece& p, float z0, float z1, float r0, float r1) {
  const MaterialId cloth =
      p.material("shade", plain("fabric", {40, 34, 26}, 0.4, 91), {0.74F, 0.60F, 0.40F});
  const std::array<Vector2f, 7> profile = {{{r0, z0},
                                            {0.75F * r0 + 0.25F * r1, 0.75F * z0 + 0.25F * z1},
                                            {0.5F * (r0 + r1), 0.5F * (z0 + z1)},
                                            {0.25F * r0 + 0.75F * r1, 0.25F * z0 + 0.75F * z1},
                                            {r1, z1},
                                            {r1 - 0.003F, z1},
                                            {r0 - 0.003F, z0 + 0.001F}}};
  p.mesh.lathe(cloth, {0, 0, 0}, profile, 24);
}

MaterialId glow(Piece& p) {
  return p.fixed(plain("ceramic", {12, 12, 12}, 0.05, 92), {1.1F, 1.0F, 0.85F});
}

}  // namespace

void floor_lamp(Piece& p) {
  const float r = 0.5F * p.size_m.x(), h = p.size_m.z();
  const MaterialId metal = p.material("metal", plain("brushed_metal", {60, 56, 52}, 0.3, 93));
  MeshBuilder& m = p.mesh;
  m.lathe(
      metal, {0, 0, 0},
      std::array<Vector2f, 5>{
          {{0.001F, 0}, {0.8F * r, 0}, {0.8F * r, 0.015F}, {0.2F * r, 0.028F}, {0.001F, 0.03F}}},
      24);
  m.cylinder(metal, {0, 0, 0.02F}, {0, 0, h - 0.12F}, {0.012F, 0.010F}, 10);
  shade(p, h - 0.30F, h, r, 0.72F * r);
  m.cylinder(metal, {-0.7F * r, 0, h - 0.02F}, {0.7F * r, 0, h - 0.02F}, {0.003F, 0.003F}, 6);
  m.cylinder(metal, {0, -0.7F * r, h - 0.02F}, {0, 0.7F * r, h - 0.02F}, {0.003F, 0.003F}, 6);
}

void table_lamp(Piece& p) {
  const float r = 0.5F * p.size_m.x(), h = p.size_m.z();
  const MaterialId base = p.material("base", plain("ceramic", {176, 152, 118}, 0.4, 94));
  MeshBuilder& m = p.mesh;
  const float f = 0.52F * h;
  m.lathe(base, {0, 0, 0},
          std::array<Vector2f, 9>{{{0.001F, 0},
                                   {0.50F * r, 0},
                                   {0.50F * r, 0.012F},
                                   {0.30F * r, 0.02F},
                                   {0.55F * r, 0.35F * f},
                                   {0.50F * r, 0.55F * f},
                                   {0.18F * r, 0.85F * f},
                                   {0.14F * r, f},
                                   {0.001F, f + 0.03F}}},
          20);
  shade(p, 0.54F * h, h, r, 0.66F * r);
}

void ceiling_lamp(Piece& p) {
  const float r = 0.5F * p.size_m.x(), h = p.size_m.z();
  const MaterialId rim = p.material("wood", oak());
  p.mesh.lathe(
      rim, {0, 0, 0},
      std::array<Vector2f, 5>{
          {{0.86F * r, 0.3F * h}, {r, 0.3F * h}, {r, h}, {0.86F * r, h}, {0.86F * r, 0.3F * h}}},
      36);
  p.mesh.lathe(glow(p), {0, 0, 0},
               std::array<Vector2f, 5>{{{0.001F, 0},
                                        {0.35F * r, 0.02F * h},
                                        {0.65F * r, 0.15F * h},
                                        {0.82F * r, 0.4F * h},
                                        {0.87F * r, 0.95F * h}}},
               36);
}

void pendant_lamp(Piece& p) {
  const float r = 0.5F * p.size_m.x(), h = p.size_m.z();
  const MaterialId dome = p.material("dome", plain("brushed_metal", {58, 84, 80}, 0.3, 95));
  const MaterialId black = p.fixed(plain("plastic", {30, 30, 32}, 0.2, 2));
  MeshBuilder& m = p.mesh;
  const float k = 0.26F;  // height of the dome
  m.lathe(dome, {0, 0, 0},
          std::array<Vector2f, 10>{{{r, 0},
                                    {r, 0.012F},
                                    {0.93F * r, 0.4F * k},
                                    {0.70F * r, 0.72F * k},
                                    {0.30F * r, 0.92F * k},
                                    {0.10F * r, k},
                                    {0.09F * r, 0.9F * k},
                                    {0.67F * r, 0.68F * k},
                                    {0.90F * r, 0.38F * k},
                                    {0.985F * r, 0.002F}}},
          30);
  m.lathe(glow(p), {0, 0, 0.06F},
          std::array<Vector2f, 5>{
              {{0.001F, 0}, {0.045F, 0.015F}, {0.055F, 0.05F}, {0.03F, 0.10F}, {0.02F, 0.16F}}},
          16);
  m.cylinder(black, {0, 0, 0.9F * k}, {0, 0, h - 0.02F}, {0.004F, 0.004F}, 6, false);
  m.cylinder(black, {0, 0, h - 0.03F}, {0, 0, h}, {0.05F, 0.055F}, 16);
}

}  // namespace mh::build
