"""What `rosrun screwline report` is made of."""
