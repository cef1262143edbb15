# The interface's messages and services, one line each.
add_message_files(FILES
  ErrorCode.msg
  IkSolution.msg
  ProfileInfo.msg
  SingularityCondition.msg
  TimeScaling.msg
  TrajectoryMetrics.msg
  Waypoint.msg
)
add_service_files(FILES
  AnalyzeSingularity.srv
  ComputeFK.srv
  ComputeFKBatch.srv
  ComputeIK.srv
  ComputeIKBatch.srv
  ComputeJacobian.srv
  ComputeStatics.srv
  ComputeVelocity.srv
  Derive.srv
  Describe.srv
  ExecuteTrajectory.srv
  ListProfiles.srv
  PlanTrajectory.srv
)
generate_messages(DEPENDENCIES geometry_msgs sensor_msgs std_msgs trajectory_msgs)
