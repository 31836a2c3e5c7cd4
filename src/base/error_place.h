#pragma once

#include <string>
#include <typeinfo>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
/// Runs `work` and returns its result. An Error gets the message `text_of(message)`. The type of an error tells the
/// caller what to do, so it stays: a NotKnownYet gets the new message too, and errors of other types pass unchanged.
template <class TextOf, class Work>
auto withErrorText(const TextOf& text_of, const Work& work)
{
  try
  {
    return work();
  }
  catch (const NotKnownYet& error)
  {
    throw NotKnownYet(text_of(error.what()));
  }
  catch (const Error& error)
  {
    if (typeid(error) != typeid(Error))
      throw;
    throw Error(text_of(error.what()));
  }
}

/// The same; the new message begins with a place: "PLACE: MESSAGE".
template <class Work>
auto withErrorPlace(const std::string& place, const Work& work)
{
  return withErrorText([&place](const std::string& message) { return place + ": " + message; }, work);
}
}  // namespace gpu_planning_scene::core
