#include "model/meshes/collada_transform.h"

#include <string_view>

#include "base/math_constants.h"
#include "model/meshes/collada_document.h"

// COLLADA 1.4.1, chapter 5: the child elements of <node>.
namespace gpu_planning_scene::core
{
namespace
{
using tinyxml2::XMLElement;

/// The numbers of a transform, from which vectors are taken one after the other.
class Values
{
 public:
  Values(const XMLElement& element, std::size_t count) : element_(element), values_(numbersOf(element))
  {
    if (values_.size() != count)
      failAt(element, "it has " + std::to_string(values_.size()) + " numbers, not " + std::to_string(count));
  }

  double number(std::size_t i) const { return values_[i]; }
  Eigen::Vector3d vector(std::size_t i) const { return {values_[i], values_[i + 1], values_[i + 2]}; }

  /// Throws Error if the vector is so short that it has no direction.
  Eigen::Vector3d direction(const Eigen::Vector3d& vector) const
  {
    const double length = vector.stableNorm();
    if (!(length > 0.0))
      failAt(element_, "it has a direction of length 0");
    return vector / length;
  }

 private:
  const XMLElement& element_;
  std::vector<double> values_;
};

Eigen::Affine3d matrix(const XMLElement& element)
{
  const Values values(element, 16);
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      transform(row, column) = values.number(static_cast<std::size_t>(4 * row + column));
  if (values.vector(12) != Eigen::Vector3d::Zero() || values.number(15) != 1.0)
    failAt(element, "its last row is not 0 0 0 1");
  return transform;
}

Eigen::Affine3d rotation(const XMLElement& element)
{
  const Values values(element, 4);
  const double angle = values.number(3) * kPi / 180.0;
  if (angle == 0.0)
    return Eigen::Affine3d::Identity();  // some programs write the axis 0 0 0 then
  return Eigen::Affine3d(Eigen::AngleAxisd(angle, values.direction(values.vector(0))));
}

/// Looks along -z, with y upwards, like a camera.
Eigen::Affine3d lookAt(const XMLElement& element)
{
  const Values values(element, 9);
  const Eigen::Vector3d eye = values.vector(0);
  const Eigen::Vector3d z = values.direction(eye - values.vector(3));
  const Eigen::Vector3d x = values.direction(values.direction(values.vector(6)).cross(z));
  Eigen::Affine3d transform(Eigen::Translation3d{eye});
  transform.linear() << x, z.cross(x), z;
  return transform;
}
}  // namespace

bool isColladaTransform(const XMLElement& element)
{
  const std::string_view name = element.Name();
  return name == "matrix" || name == "translate" || name == "rotate" || name == "scale" || name == "lookat" ||
         name == "skew";
}

Eigen::Affine3d colladaTransform(const XMLElement& element)
{
  const std::string_view name = element.Name();
  if (name == "matrix")
    return matrix(element);
  if (name == "translate")
    return Eigen::Affine3d(Eigen::Translation3d(Values(element, 3).vector(0)));
  if (name == "rotate")
    return rotation(element);
  if (name == "scale")
    return Eigen::Affine3d(Eigen::Scaling(Values(element, 3).vector(0)));
  if (name == "lookat")
    return lookAt(element);
  if (Values(element, 7).number(0) != 0.0)
    failAt(element, "programs do not agree on what it means; export the model with <matrix>");
  return Eigen::Affine3d::Identity();  // some programs write a <skew> of 0 degrees in each node
}
}  // namespace gpu_planning_scene::core
