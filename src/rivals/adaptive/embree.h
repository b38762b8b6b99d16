// Embree 3 or 4. They differ in how they are asked whether rays are occluded; nothing else knows which of them is used.
#pragma once

#if EXACTFF_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace exactff::adaptive::embree {

// What Embree is told about the rays of a packet.
enum class Order { kCoherent, kIncoherent };

#if EXACTFF_EMBREE_MAJOR >= 4

// What the filter sees of a query.
using QueryContext = RTCRayQueryContext;

// The flag of a scene whose queries bring a filter.
inline constexpr RTCSceneFlags kFilterOfQuery = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;

// Where a ray is occluded, its `tfar` becomes negative. `valid` is -1 for each ray that is asked about, else 0. The
// filter may be null; it decides about every hit, and gets `context`, which is initialised here.
inline void find_occluded(const int* valid, RTCScene scene, RTCRay16& rays, Order order, QueryContext& context,
                          RTCFilterFunctionN filter) {
  rtcInitRayQueryContext(&context);
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  // For every geometry of the scene: otherwise the filter would be called only for those that allow it.
  const int invoked = filter == nullptr ? 0 : RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  const int told = order == Order::kCoherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  arguments.flags = static_cast<RTCRayQueryFlags>(told | invoked);
  arguments.context = &context;
  arguments.filter = filter;
  rtcOccluded16(valid, scene, &rays, &arguments);
}

#else

using QueryContext = RTCIntersectContext;

inline constexpr RTCSceneFlags kFilterOfQuery = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;

inline void find_occluded(const int* valid, RTCScene scene, RTCRay16& rays, Order order, QueryContext& context,
                          RTCFilterFunctionN filter) {
  rtcInitIntersectContext(&context);
  context.flags =
      order == Order::kCoherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  context.filter = filter;
  rtcOccluded16(valid, scene, &context, &rays);
}

#endif

}  // namespace exactff::adaptive::embree
