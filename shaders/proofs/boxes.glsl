// The oriented boxes of two robot instances, as in src/collision/cpu/lanes/lane_boxes.h: the test of two boxes by
// their 15 possible separating axes (Gottschalk, Lin and Manocha, "OBBTree", 1996). Lengths are in metres.

struct PlacedBox
{
  mat3 axes;  // its columns
  vec3 center;
  vec3 half_lengths;
};

PlacedBox placedBox(ProofInstance instance, FrameRows frame)
{
  PlacedBox box;
  for (int i = 0; i < 3; ++i)
  {
    const vec4 axis = proofNumbers(instance.at + INSTANCE_AXES + uint(i));
    precise const vec3 placed = vec3(fma(frame.x.x, axis.x, fma(frame.x.y, axis.y, frame.x.z * axis.z)),
                                     fma(frame.y.x, axis.x, fma(frame.y.y, axis.y, frame.y.z * axis.z)),
                                     fma(frame.z.x, axis.x, fma(frame.z.y, axis.y, frame.z.z * axis.z)));
    box.axes[i] = placed;
    box.half_lengths[i] = axis.w;
  }
  box.center = placedIn(frame, proofNumbers(instance.at + INSTANCE_BOX_CENTER).xyz);
  return box;
}

// True if the boxes of two instances are apart. `thresholds`: x: added to the half lengths of b; y: added to the
// absolute values of the relative rotation.
bool boxesApart(ProofInstance of_a, FrameRows frame_a, ProofInstance of_b, FrameRows frame_b, vec2 thresholds)
{
  const PlacedBox a = placedBox(of_a, frame_a);
  const PlacedBox b = placedBox(of_b, frame_b);
  const vec3 size_a = a.half_lengths;
  const vec3 size_b = b.half_lengths + thresholds.x;
  const mat3 into_a = transpose(a.axes);
  precise const mat3 r = into_a * b.axes;  // r[j][i]: axis i of a times axis j of b
  const mat3 abs_r = mat3(abs(r[0]) + thresholds.y, abs(r[1]) + thresholds.y, abs(r[2]) + thresholds.y);
  const vec3 between = vectorBetween(a.center, b.center);
  precise const vec3 t = into_a * between;
  bool apart = any(greaterThan(abs(t), size_a + abs_r * size_b)) ||
               any(greaterThan(abs(t * r), size_a * abs_r + size_b));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      apart = apart || abs(t[i2] * r[j][i1] - t[i1] * r[j][i2]) >
                           size_a[i1] * abs_r[j][i2] + size_a[i2] * abs_r[j][i1] + size_b[j1] * abs_r[j2][i] +
                               size_b[j2] * abs_r[j1][i];
    }
  return apart;
}

// The frame of b in the frame of a.
FrameRows relativeFrame(FrameRows a, FrameRows b)
{
  const mat3 into_a = mat3(a.x.xyz, a.y.xyz, a.z.xyz);  // its columns are the rows of a
  precise const vec3 between = vec3(b.x.w - a.x.w, b.y.w - a.y.w, b.z.w - a.z.w);
  precise const mat3 rotation = into_a * transpose(mat3(b.x.xyz, b.y.xyz, b.z.xyz));
  precise const vec3 translation = into_a * between;
  return FrameRows(vec4(rotation[0].x, rotation[1].x, rotation[2].x, translation.x),
                   vec4(rotation[0].y, rotation[1].y, rotation[2].y, translation.y),
                   vec4(rotation[0].z, rotation[1].z, rotation[2].z, translation.z));
}
