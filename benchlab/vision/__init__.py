"""From pictures to curvature: colour, markers, linking, circle, scale, and drawn pictures of known truth."""
