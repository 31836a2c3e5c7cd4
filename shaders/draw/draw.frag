// One invocation per drawn pixel of a picture: diffuse light from the eye and from a lamp above, with the lamp's soft
// shadows. Both faces of a triangle are lit alike, because meshes may be open or inside out.
// Shadows: L. Williams, "Casting curved shadows on curved surfaces", 1978; filtered as in W. Reeves, D. Salesin and
// R. Cook, "Rendering antialiased shadows with depth maps", 1987.

#include "shader_constants.h"

layout(location = LOCATION_EYE) uniform vec3 eye;    // metres, in the planning frame
layout(location = LOCATION_LAMP) uniform vec3 lamp;  // direction to the lamp, of unit length
// From the planning frame to the shadow map: 0 to 1 in all three axes.
layout(location = LOCATION_TO_LAMP) uniform mat4 to_lamp;
// Half the width of a shadow's edge, as a share of the shadow map.
layout(location = LOCATION_SOFTNESS) uniform float softness;
layout(location = LOCATION_LIFT) uniform float lift;  // metres: a surface within this distance does not shade itself
// The floor's centre and radius in metres. With radius 0, the triangles do not belong to the floor.
layout(location = LOCATION_GROUND) uniform vec4 ground;
layout(location = LOCATION_BACKGROUND) uniform vec3 background;
// With opacity above 0, all pixels have this colour, without light.
layout(location = LOCATION_FLAT_COLOR) uniform vec4 flat_color;
layout(binding = UNIT_SHADOW_MAP) uniform sampler2DShadow shadow_map;

layout(location = 0) in vec3 place;        // metres, in the planning frame
layout(location = 1) flat in vec3 facing;  // the triangle's normal, of unit length
layout(location = 2) flat in vec4 paint;   // the triangle's colour

layout(location = 0) out vec4 color;

const int steps = 4;  // samples of the shadow map in each direction from the middle

/// The share of the lamp's light that reaches the point.
float lit(vec3 point)
{
  vec3 at = (to_lamp * vec4(point, 1.0)).xyz;
  at.z = min(at.z, 1.0);  // the floor extends beyond the shadow map
  float sum = 0.0;
  for (int i = -steps; i <= steps; ++i)
    for (int k = -steps; k <= steps; ++k)
      sum += texture(shadow_map, vec3(at.xy + softness / float(steps) * vec2(i, k), at.z));
  return sum / float((2 * steps + 1) * (2 * steps + 1));
}

void main()
{
  vec3 towards_eye = normalize(eye - place);
  vec3 outward = dot(facing, towards_eye) < 0.0 ? -facing : facing;
  if (flat_color.a > 0.0)
  {
    color = flat_color;
  }
  else if (ground.w > 0.0)
  {
    float fade = smoothstep(0.35, 1.0, distance(place, ground.xyz) / ground.w);
    color = vec4(mix(paint.rgb * (0.62 + 0.38 * lit(place)), background, fade), 1.0);
  }
  else
  {
    float light = 0.40 + 0.36 * dot(outward, towards_eye) +
                  0.30 * max(0.0, dot(outward, lamp)) * lit(place + lift * outward);
    color = vec4(paint.rgb * min(light, 1.0), 1.0);
  }
}
