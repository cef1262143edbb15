#ifndef SCREWLINE_ROS_MESSAGES_H
#define SCREWLINE_ROS_MESSAGES_H

// The generated messages live in namespace screwline too, and some are named like a type of the core: those are called
// <Name>Msg in C++. Include this header, not the generated ones, wherever headers of the core are included as well.
#define ErrorCode ErrorCodeMsg
#define IkSolution IkSolutionMsg
#define ProfileInfo ProfileInfoMsg
#define SingularityCondition SingularityConditionMsg
#define TimeScaling TimeScalingMsg
#define TrajectoryMetrics TrajectoryMetricsMsg
#define Waypoint WaypointMsg
#include <screwline/ErrorCode.h>
#include <screwline/IkSolution.h>
#include <screwline/ProfileInfo.h>
#include <screwline/SingularityCondition.h>
#include <screwline/TimeScaling.h>
#include <screwline/TrajectoryMetrics.h>
#include <screwline/Waypoint.h>
#undef ErrorCode
#undef IkSolution
#undef ProfileInfo
#undef SingularityCondition
#undef TimeScaling
#undef TrajectoryMetrics
#undef Waypoint

#include <screwline/AnalyzeSingularity.h>
#include <screwline/ComputeFK.h>
#include <screwline/ComputeIK.h>
#include <screwline/ComputeJacobian.h>
#include <screwline/ComputeStatics.h>
#include <screwline/ComputeVelocity.h>
#include <screwline/Describe.h>

#endif  // SCREWLINE_ROS_MESSAGES_H
