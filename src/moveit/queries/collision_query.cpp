#include "moveit/queries/collision_query.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "moveit/pairs/pair_contacts.h"
#include "moveit/shapes/log.h"

namespace gpu_planning_scene::detector
{
namespace
{
using collision_detection::CollisionRequest;
using collision_detection::CollisionResult;
using collision_detection::Contact;

/// The contact from the body with the first name to the other one, as in the key of the result.
Contact contactBetween(const ShapeInstance& a, const ShapeInstance& b, const core::ShapeContact& found)
{
  const bool swapped = *b.body.name < *a.body.name;
  const Body& first = swapped ? b.body : a.body;
  const Body& second = swapped ? a.body : b.body;
  Contact contact;
  contact.pos = found.point;
  contact.normal = swapped ? Eigen::Vector3d(-found.normal) : found.normal;
  contact.depth = found.depth;
  contact.body_name_1 = *first.name;
  contact.body_type_1 = first.type;
  contact.body_name_2 = *second.name;
  contact.body_type_2 = second.type;
  contact.percent_interpolation = 0.0;
  contact.nearest_points[0] = contact.pos + 0.5 * contact.depth * contact.normal;
  contact.nearest_points[1] = contact.pos - 0.5 * contact.depth * contact.normal;
  return contact;
}
}  // namespace

CollisionQuery::CollisionQuery(const CollisionRequest& request, CollisionResult& result, const PairFilter& filter,
                               PairScratch& scratch)
  : request_(request), result_(result), filter_(filter), scratch_(scratch)
{
  is_done_ = isComplete();
}

bool CollisionQuery::isComplete() const
{
  return result_.collision && !request_.cost && (!request_.contacts || result_.contact_count >= request_.max_contacts);
}

bool CollisionQuery::test(const ShapeInstance& a, const ShapeInstance& b)
{
  // The oriented boxes cost less than the matrix, which finds the pair by two names.
  if (sameBody(a.body, b.body) || !boxesOverlap(a, b))
    return false;
  const PairFilter::Rule rule = filter_.rule(a.body, b.body);
  if (rule == PairFilter::Rule::Skip)
    return false;
  if (collide(a, b, scratch_) && (rule == PairFilter::Rule::Check || isRefused(a, b)))
    addCollision(a, b, rule == PairFilter::Rule::Check);
  is_done_ = isComplete() || (request_.is_done && request_.is_done(result_));
  return is_done_;
}

std::size_t CollisionQuery::wantedContacts(const ShapeInstance& a, const ShapeInstance& b) const
{
  if (!request_.contacts || result_.contact_count >= request_.max_contacts)
    return 0;
  const auto known = result_.contacts.find(keyOf(a, b));
  const std::size_t have = known == result_.contacts.end() ? 0 : known->second.size();
  return have >= request_.max_contacts_per_pair
             ? 0
             : std::min(request_.max_contacts_per_pair - have, request_.max_contacts - result_.contact_count);
}

void CollisionQuery::addContact(const ShapeInstance& a, const ShapeInstance& b, const core::ShapeContact& contact)
{
  result_.contacts[keyOf(a, b)].push_back(contactBetween(a, b, contact));
  ++result_.contact_count;
}

bool CollisionQuery::isRefused(const ShapeInstance& a, const ShapeInstance& b)
{
  const collision_detection::DecideContactFn decider = filter_.decider(a.body, b.body);
  bool are_all = true;
  const std::vector<core::ShapeContact> contacts =
      contactsOf(a, b, std::numeric_limits<std::size_t>::max(), scratch_, &are_all);
  bool is_refused = false;
  for (const core::ShapeContact& found : contacts)
  {
    Contact contact = contactBetween(a, b, found);
    if (decider && decider(contact))
      continue;
    is_refused = true;
    if (wantedContacts(a, b) == 0)
      break;
    addContact(a, b, found);
  }
  if (is_refused || are_all)
    return is_refused;
  // The decider might refuse one of the contacts that were not computed.
  if (wantedContacts(a, b) > 0)
    addContact(a, b, contacts.front());
  return true;
}

/// The place of the pair, as far as the bounds of both instances tell it. FCL counts each pair of triangles instead.
void CollisionQuery::addCostSource(const ShapeInstance& a, const ShapeInstance& b)
{
  const Eigen::AlignedBox3d common = a.bounds.intersection(b.bounds);
  if (!common.min().allFinite() || !common.max().allFinite())
    return;
  collision_detection::CostSource source;
  std::copy_n(common.min().data(), 3, source.aabb_min.begin());
  std::copy_n(common.max().data(), 3, source.aabb_max.begin());
  source.cost = 1.0;
  result_.cost_sources.insert(source);
  while (result_.cost_sources.size() > request_.max_cost_sources)
    result_.cost_sources.erase(std::prev(result_.cost_sources.end()));
}

void CollisionQuery::addCollision(const ShapeInstance& a, const ShapeInstance& b, bool with_contacts)
{
  result_.collision = true;
  if (request_.verbose)
    ROS_INFO_STREAM_NAMED(kLogName, "'" << *a.body.name << "' collides with '" << *b.body.name << "'");
  const std::size_t wanted = with_contacts ? wantedContacts(a, b) : 0;
  if (wanted > 0)
    for (const core::ShapeContact& contact : contactsOf(a, b, wanted, scratch_))
      addContact(a, b, contact);
  if (request_.cost)
    addCostSource(a, b);
}
}  // namespace gpu_planning_scene::detector
