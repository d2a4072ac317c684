"""Steps from a pose nearby to a closed one: Newton, Levenberg-Marquardt, chord steps, least residual."""
