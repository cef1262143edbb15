# The interface's messages and services, one line each.
add_message_files(FILES
  ErrorCode.msg
)
generate_messages(DEPENDENCIES geometry_msgs sensor_msgs std_msgs trajectory_msgs)
