// Embree 3 (Debian 12) and Embree 4 (Debian 13) by the same calls: what a query carries moved from the
// intersect context into arguments of its own between the two. Embree is a comparator, never behind the
// user's own result.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace gnomon::test {

#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
inline constexpr RTCSceneFlags filter_by_query = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
using EmbreeContext = RTCIntersectContext;
inline constexpr RTCSceneFlags filter_by_query = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif

/// What the rays of a query have in common. `filter` is asked about every hit of a scene with
/// filter_by_query; it gets the address of `context`, which is that of the query.
struct EmbreeQuery {
  EmbreeContext context;
  RTCFilterFunctionN filter = nullptr;
  bool coherent = false;

  explicit EmbreeQuery(bool are_coherent = false, RTCFilterFunctionN filter_of_hits = nullptr)
      : filter(filter_of_hits), coherent(are_coherent) {
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&context);
#else
    rtcInitIntersectContext(&context);
    context.filter = filter;
    if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
#endif
  }
};

#if RTC_VERSION_MAJOR >= 4
template <class Arguments>
void fill_arguments(EmbreeQuery& query, Arguments& arguments) {
  unsigned flags = query.coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  if (query.filter != nullptr) flags |= RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  arguments.flags = static_cast<RTCRayQueryFlags>(flags);
  arguments.context = &query.context;
  arguments.filter = query.filter;
}
inline RTCIntersectArguments intersect_arguments(EmbreeQuery& query) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  fill_arguments(query, arguments);
  return arguments;
}
inline RTCOccludedArguments occluded_arguments(EmbreeQuery& query) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  fill_arguments(query, arguments);
  return arguments;
}
inline void embree_intersect(RTCScene scene, EmbreeQuery& query, RTCRayHit& ray) {
  RTCIntersectArguments arguments = intersect_arguments(query);
  rtcIntersect1(scene, &ray, &arguments);
}
inline void embree_intersect(const int* valid, RTCScene scene, EmbreeQuery& query, RTCRayHit16& rays) {
  RTCIntersectArguments arguments = intersect_arguments(query);
  rtcIntersect16(valid, scene, &rays, &arguments);
}
inline void embree_occluded(RTCScene scene, EmbreeQuery& query, RTCRay& ray) {
  RTCOccludedArguments arguments = occluded_arguments(query);
  rtcOccluded1(scene, &ray, &arguments);
}
inline void embree_occluded(const int* valid, RTCScene scene, EmbreeQuery& query, RTCRay16& rays) {
  RTCOccludedArguments arguments = occluded_arguments(query);
  rtcOccluded16(valid, scene, &rays, &arguments);
}
#else
inline void embree_intersect(RTCScene scene, EmbreeQuery& query, RTCRayHit& ray) {
  rtcIntersect1(scene, &query.context, &ray);
}
inline void embree_intersect(const int* valid, RTCScene scene, EmbreeQuery& query, RTCRayHit16& rays) {
  rtcIntersect16(valid, scene, &query.context, &rays);
}
inline void embree_occluded(RTCScene scene, EmbreeQuery& query, RTCRay& ray) {
  rtcOccluded1(scene, &query.context, &ray);
}
inline void embree_occluded(const int* valid, RTCScene scene, EmbreeQuery& query, RTCRay16& rays) {
  rtcOccluded16(valid, scene, &query.context, &rays);
}
#endif

}  // namespace gnomon::test
