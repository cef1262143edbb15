"""What `rosrun screwline scenario` is made of."""
