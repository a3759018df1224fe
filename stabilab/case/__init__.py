"""Case files: TOML to scenes and states, every fault with its file, line and key."""
