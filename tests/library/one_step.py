"""one_step.py: the module finds its library and runs case.yaml for a step."""

import shoal

run = shoal.Run("case.yaml")
run.step()
assert run["x"].shape == (2, 9, 2)
