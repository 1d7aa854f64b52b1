// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace mh {

// The camera's frame is x right, y down, z forward; row 0 of an image is the first that is read
// back, so nothing is flipped. Depth is reversed (near / z), which has the best precision in
// floats.
inline constexpr const char* kVertexShader = R"(
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

// The level of detail is chosen as in TextureTable::place, by the texels that a pixel covers; holes
// are found as in CutOuts::is_hole. Only a scene with holes uses a shader that may discard, since
// the depth test then runs after the shader.
inline constexpr const char* kVersion = "#version 450 core\n";
inline constexpr const char* kVersionWithHoles = "#version 450 core\n#define HOLES\n";
inline constexpr const char* kFragmentShader = R"(
in vec2 texture_place;
in vec3 vertex_gain;
in vec3 from_origin;
uniform sampler2D image;
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
    light *= textureLod(image, texture_place, clamp(level, 0.0, 15.0)).rgb;
  }
  color = vec4(clamp(light + emission, 0.0, white), 1.0);
  label = texelFetch(labels, face).xy;
}
)";

}  // namespace mh
