// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/finished_map.hpp"

#include <sstream>

#include "slam/map/archive.hpp"

namespace mh {
namespace archive {

/// Serializes a record through its list of fields, without their names.
template <class A, class T>
requires MaybeConst<T, MappingOutcome> || MaybeConst<T, MappedFrame> ||
    MaybeConst<T, LoopClosure> || MaybeConst<T, SkippedFrames> || MaybeConst<T, MatcherCounts>
void fields(A& a, T& record) {
  const auto visit = [&](const char*, auto&& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_enum_v<Value>) {
      auto number = static_cast<int>(value);
      a(number);
      if constexpr (A::kReads) value = static_cast<Value>(number);
    } else if constexpr (requires { value.value; }) {
      a(value.value);
    } else {
      a(value);
    }
  };
  mh::fields(record, visit);
}
}  // namespace archive

std::string encode(const FinishedMap& map) {
  std::ostringstream volume;
  map.volume->write_ot(volume);
  archive::Writer writer;
  writer(map.outcome.calls, map.outcome, map.system, volume.str());
  return writer.take();
}

FinishedMap decode_finished_map(const std::string& bytes, const std::string& name) {
  archive::Reader reader(bytes, name);
  FinishedMap map;
  std::string volume;
  reader(map.outcome.calls, map.outcome, map.system, volume);
  reader.require(reader.at_end(), "it has data after its end");
  std::istringstream stream(volume);
  map.volume = std::make_shared<const VoxelMap>(VoxelMap::read_ot(stream, name));
  return map;
}

}  // namespace mh
