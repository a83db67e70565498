"""What is said about a flight: measured verdicts and unambiguous prompts. Knows products, not algorithms."""
