// byte_as_sampled: A byte is the eight samples between a LOW start bit and a HIGH stop bit, the first one lowest.
// samples_timed: The first sample of a byte is half a bit after its edge, less the delay of the synchroniser; each other one a bit after the one before, to the cycle.
reg [9:0] f_samples;
reg [3:0] f_count; initial f_count = 4'd0;
reg [14:0] f_since; initial f_since = 15'd0;
always @(posedge clock) begin
    f_since <= f_since + 15'd1;
    if (sample) begin
        f_samples <= {sync1, f_samples[9:1]};
        f_count <= f_count + 4'd1;
        f_since <= 15'd1;
    end
    if (!active | reset) begin
        f_count <= 4'd0;
        f_since <= 15'd0;
    end
end
always @* begin
    byte_as_sampled: assert (!good | (f_samples[9] & !f_samples[0] & (data == f_samples[8:1])));
    byte_as_sampled_whole: assert (!(good | bad) | ((shift == f_samples) & !f_samples[0]));
    byte_as_sampled_count: assert (!active | ((f_count <= 4'd9) & (in_start_bit == (f_count == 4'd0))));
    byte_as_sampled_start: assert (!active | in_start_bit | !f_samples[4'd10 - f_count]);
    byte_as_sampled_so_far: assert (!active | (shift == (((f_samples >> (4'd10 - f_count)) << (4'd10 - f_count)) | (10'd512 >> f_count))));
    byte_as_sampled_active: assert (!sample | active);
    samples_timed: assert (!sample | ((count == 15'd0) & (f_since == ((f_count == 4'd0) ? MIDDLE_COUNT : LAST_COUNT) + 15'd1)));
    samples_timed_so_far: assert (!active | sample | ((f_since == count) & (count <= limit)));
end
