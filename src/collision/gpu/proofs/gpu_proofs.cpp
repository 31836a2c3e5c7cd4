#include "collision/gpu/proofs/gpu_proofs.h"

#include <algorithm>

#include "collision/cpu/lanes/lane_scene.h"
#include "collision/gpu/proofs/proof_names.h"
#include "collision/gpu/proofs/proof_texels.h"
#include "collision/gpu/proofs/state_shader.h"
#include "shader_constants.h"

// Four dispatches: the states, the open pairs of two links, those of a link and an object, and what these two leave
// open. Each dispatch lists what remains, so that no invocation waits for a neighbour that has more to do. Own method.
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kFrameBytes = POSE_TEXELS * TexelBuffer::kTexelBytes;

/// Room for the centres of a scene, so that an attached object does not need another program each time.
std::size_t roomFor(std::size_t centers)
{
  constexpr std::size_t kStep = 16;
  return (centers / kStep + 1) * kStep;
}
}  // namespace

void GpuProofs::set(const LaneScene& scene)
{
  clear();
  const lanes::Model& model = scene.model();
  const std::size_t centers = model.instances.count + model.clusters.count;
  const std::string text = stateShader(scene, scene.linkCenters().size() == centers ? 0 : roomFor(centers));
  if (text != robot_shader_)
  {
    for (Programs& made : programs_)
      made.states.reset();
    robot_shader_ = text;
  }
  programs(false);
  const std::vector<ProofTexel> texels = proofTexels(scene);
  records_.reserve(texels.size() * sizeof(ProofTexel));
  records_.buffer().write(texels);
  const std::vector<int> places = placesOfFrames(model);
  frame_count_ = static_cast<std::size_t>(std::count_if(places.begin(), places.end(), [](int p) { return p >= 0; }));
  exist_ = true;
}

std::size_t GpuProofs::maxStates() const
{
  return std::max<std::size_t>(1, TexelBuffer::maxBytes() / (std::max<std::size_t>(1, frame_count_) * kFrameBytes));
}

GpuProofs::Programs& GpuProofs::programs(bool margins)
{
  Programs& made = programs_[margins ? 1 : 0];
  const std::string definitions = definitions_ + (margins ? "#define MARGINS 1\n" : "");
  if (!made.self_pairs)
    made.self_pairs.emplace(folder_, "proofs/prove_self_pairs.comp", definitions);
  if (!made.world_pairs)
    made.world_pairs.emplace(folder_, "proofs/prove_world_pairs.comp", definitions);
  if (!made.fine_pairs)
    made.fine_pairs.emplace(folder_, "proofs/prove_fine_pairs.comp", definitions);
  if (!made.states)
    made.states.emplace(Program::fromText(folder_, "proofs of states", definitions + robot_shader_));
  return made;
}

void GpuProofs::start(const Part& part, BatchLists& lists)
{
  Programs& made = programs(part.margins != 0);
  frames_.reserve(std::size_t{part.states} * frame_count_ * kFrameBytes);
  for (const Program* program : {&*made.states, &*made.self_pairs, &*made.world_pairs, &*made.fine_pairs})
  {
    program->set(LOCATION_STATE_COUNT, part.states);
    program->set(LOCATION_ROBOT_COUNT, part.robot_instances);
    program->set(LOCATION_OPEN_PAIR_CAPACITY, lists.capacity.open_pairs);
    if (part.margins != 0)
      program->set(LOCATION_MARGIN_COUNT, part.margins);
  }
  records_.bindTexture(UNIT_PROOFS);
  lists.open_self_pairs.bindStorage(BINDING_C);
  lists.open_world_pairs.bindStorage(BINDING_D);
  frames_.buffer().bindStorage(BINDING_A);
  made.states->dispatch(groupsFor(part.states));

  frames_.bindTexture(UNIT_FRAMES);
  made.fine_pairs->set(LOCATION_CANDIDATE_CAPACITY, lists.capacity.candidates);
  lists.fine_pairs.bindStorage(BINDING_A);
  lists.candidates.buffer().bindStorage(BINDING_B);
  lists.open_states.bindStorage(BINDING_OPEN_STATES);
  for (const auto& [program, list] :
       {std::pair(&*made.self_pairs, LIST_OPEN_SELF_PAIRS), std::pair(&*made.world_pairs, LIST_OPEN_WORLD_PAIRS),
        std::pair(&*made.fine_pairs, LIST_FINE_PAIRS)})
    program->dispatchIndirect(lists.counters, list * sizeof(std::uint32_t));
}

std::vector<float> GpuProofs::readFrames(std::size_t states) const
{
  std::vector<float> rows(states * frame_count_ * POSE_FLOATS);
  frames_.buffer().read(rows.data(), rows.size() * sizeof(float));
  return rows;
}
}  // namespace gpu_planning_scene::core
