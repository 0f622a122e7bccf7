"""Many runs: jobs on the workers of an executor, a scene with many settings, and the report of both."""
