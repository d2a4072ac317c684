"""Link lengths, and frames of joints placed anew."""
