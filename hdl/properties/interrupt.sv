// event_is_kept: An event stays in the status until the host clears its bit; one that comes in that cycle stays. Nothing else sets a bit.
// request_as_masked: The processor is interrupted while the mask lets an event through, and not otherwise.
reg f_past_valid; initial f_past_valid = 1'b0;
always @(posedge clock) begin
    f_past_valid <= 1'b1;
    if (f_past_valid & !$past(reset)) begin
        event_is_kept: assert (status == ($past(events_0) | ($past(status) & ~($past(selected & write & (word_address[1:0] == 2'd2)) ? $past(write_data) : 32'd0))));
        request_as_masked: assert (irq == (($past(status) & $past(mask)) != 32'd0));
    end
end
