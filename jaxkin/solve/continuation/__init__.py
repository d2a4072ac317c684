"""The branch of the assembled pose, followed along the inputs."""
