// A comparison of floats that no compiler can invert. A compiler may assume that no float is NaN, and replace a > b by
// the negation of a <= b. For a NaN, this negation is true. The function therefore compares the bits as integers.
// Returns true if a > b, for b that is not negative. The result is false if a is negative, or if a or b is NaN, because
// the bits of these numbers are larger than those of infinity.
bool provenGreater(float a, float b)
{
  const uint bits = floatBitsToUint(a);
  return bits > floatBitsToUint(b) && bits <= INFINITY_BITS;
}
