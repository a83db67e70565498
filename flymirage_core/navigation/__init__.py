"""Where to fly and how: task sets, EGO-Planner flights, what they ask of a quadrotor. Knows occupancy and boxes."""
