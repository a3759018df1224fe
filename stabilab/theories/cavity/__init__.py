"""The body with a cavity of viscous liquid, averaged."""
