#ifndef SCREWLINE_ROS_MESSAGES_H
#define SCREWLINE_ROS_MESSAGES_H

// The generated messages live in namespace screwline, as the core does; no type of the core has the name of a message.
#include <screwline/AnalyzeSingularity.h>
#include <screwline/ComputeFK.h>
#include <screwline/ComputeFKBatch.h>
#include <screwline/ComputeIK.h>
#include <screwline/ComputeIKBatch.h>
#include <screwline/ComputeJacobian.h>
#include <screwline/ComputeStatics.h>
#include <screwline/ComputeVelocity.h>
#include <screwline/Derive.h>
#include <screwline/Describe.h>
#include <screwline/ErrorCode.h>
#include <screwline/IkSolution.h>
#include <screwline/ProfileInfo.h>
#include <screwline/SingularityCondition.h>
#include <screwline/TimeScaling.h>
#include <screwline/TrajectoryMetrics.h>
#include <screwline/Waypoint.h>

#endif  // SCREWLINE_ROS_MESSAGES_H
