"""What stops a run: one class a cause. Each looks at every tick and gives a Cause once it has seen enough."""
