// The generated part of the shader defines proveState, see state_proofs.glsl.

void main()
{
  const uint state = invocationIndex();
  if (state < state_count)
    verdicts[state] = proveState(state, fetchRecords());
}
