#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/file_cache.h"
#include "collision/proofs/ball_cover.h"
#include "collision/proofs/joint_table.h"

namespace gpu_planning_scene::core
{
/// Proofs on disk, so that a second start makes none. A proof is used only if its whole key matches (see proof_key.h)
/// and its content has the expected form; otherwise it is made again. If the file system fails, no proof is found or
/// stored; this is no error. Several processes may use the folder at the same time. Thread-safe.
class ProofCache
{
 public:
  /// `folder`: empty: nothing is found or stored.
  explicit ProofCache(std::filesystem::path folder = {});

  /// The folder `proofs` in the user's cache folder. GPU_PLANNING_SCENE_PROOF_CACHE=off switches the cache off.
  static ProofCache ofUser();

  std::optional<BallCover> cover(const std::string& key) const;
  void store(const std::string& key, const BallCover& cover) const;

  /// `variables`: of the table, see tableVariables.
  std::optional<JointTable> table(const std::string& key, const std::vector<TableVariable>& variables) const;
  void store(const std::string& key, const JointTable& table) const;

  /// Removes the proofs that were used longest ago, until the rest has at most 256 MiB.
  void removeOldest() const { files_.removeOldest(); }

 private:
  FileCache files_;
};
}  // namespace gpu_planning_scene::core
