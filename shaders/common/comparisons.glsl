// Comparisons that prove something, and that no compiler may turn round.
// Whether a > b, for numbers that are not negative. Compilers may assume that no float is NaN, and then turn a comparison
// round; they may not assume it of integers. NaN has larger bits than infinity: where a or b is NaN, this is false.
bool provenGreater(float a, float b)
{
  const uint bits = floatBitsToUint(a);
  return bits > floatBitsToUint(b) && bits <= INFINITY_BITS;
}
